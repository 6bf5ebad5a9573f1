#include "SonoProbePaths.h"

#include "pqPipelineSource.h"
#include "vtkPVDataInformation.h"
#include "vtkSMBooleanDomain.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <QCoreApplication>
#include <QFile>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace {

constexpr int mostMasks = 255; // schema.json

QString tr(const char* words)
{
  return QCoreApplication::translate("SonoPathDataSet", words);
}

/// As a data set's file names a property's parameter.
QString keyOf(const char* property)
{
  QString key(property);
  key[0] = key[0].toLower();
  return key;
}

QJsonValue valueOf(vtkSMProperty* property)
{
  const vtkSMPropertyHelper value(property);
  if (auto* choices = property->FindDomain<vtkSMEnumerationDomain>())
  {
    return QString(choices->GetEntryTextForValue(value.GetAsInt()));
  }
  if (property->FindDomain<vtkSMBooleanDomain>())
  {
    return value.GetAsInt() == 1;
  }
  return value.GetAsDouble();
}

/// All that a probe has but its place; what it is called is of no account.
QJsonObject probeOf(vtkSMProxy* ultrasound)
{
  QJsonObject probe{ { "preset", "phased_p4-2" } };
  vtkSMProxy* any = ultrasound->GetSessionProxyManager()->GetPrototypeProxy("sources", "SonoProbeSource");
  const auto each = vtkSmartPointer<vtkSMPropertyIterator>::Take(any->NewPropertyIterator());
  for (each->Begin(); !each->IsAtEnd(); each->Next())
  {
    const char* name = each->GetKey();
    const auto isOneOf = [&](std::initializer_list<const char*> names) {
      return std::any_of(names.begin(), names.end(), [&](const char* one) { return std::strcmp(one, name) == 0; });
    };
    vtkSMProperty* found = ultrasound->GetProperty(name);
    if (found &&
        !isOneOf({ "PresetFile", "PositionMm", "Axial", "Lateral", "Preview", "PrepareInteraction", "MatrixPlane" }))
    {
      probe[keyOf(name)] = valueOf(found);
    }
  }
  return probe;
}

QJsonObject numbersOf(vtkSMProxy* ultrasound, std::initializer_list<const char*> properties)
{
  QJsonObject numbers;
  for (const char* name : properties)
  {
    numbers[keyOf(name)] = valueOf(ultrasound->GetProperty(name));
  }
  return numbers;
}

/// The labels' names, by that of each block of the anatomy.
QStringList structuresOf(vtkSMSourceProxy* ultrasound)
{
  QStringList names;
  vtkPVDataInformation* anatomy = ultrasound->GetDataInformation(vtkSonoUltrasound::ANATOMY);
  for (unsigned int block = 1; block < mostMasks + 1; ++block)
  {
    const std::string name = anatomy->GetBlockName(block);
    if (name.empty())
    {
      break;
    }
    names.append(QString::fromStdString(name));
  }
  return names;
}

QJsonArray masksOf(QStringList names)
{
  // A name's words may all be in a longer one: the longer one comes first and has what fits both.
  const auto words = [](const QString& name) { return name.count(' ') + name.count('_'); };
  std::stable_sort(names.begin(), names.end(), [&](const QString& a, const QString& b) { return words(a) > words(b); });
  QJsonArray masks;
  for (const QString& name : names)
  {
    masks.append(QJsonObject{ { "name", name }, { "labels", QJsonArray{ QString(name).replace('_', ' ') } } });
  }
  return masks;
}

QJsonArray vectorOf(const double* numbers)
{
  return { numbers[0], numbers[1], numbers[2] };
}

QJsonArray viewsOf(const std::vector<SonoTimedPose>& poses)
{
  QJsonArray views;
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    const double* numbers = poses[i].pose.data();
    views.append(QJsonObject{ { "name", QString("path %1").arg(i + 1) },
                              { "pose", QJsonObject{ { "positionMm", vectorOf(numbers) },
                                                     { "axial", vectorOf(numbers + 3) },
                                                     { "lateral", vectorOf(numbers + 6) } } } });
  }
  return views;
}

/// What a data set takes as the label map of a patient; empty: nothing.
QJsonObject patientOf(vtkSMProxy* labels)
{
  const QString kind = labels ? labels->GetXMLName() : "";
  if (kind == "SonoThoraxSource")
  {
    return { { "id", "thorax" },
             { "bundled", "thorax" },
             { "spacingMm", vtkSMPropertyHelper(labels, "SpacingMm").GetAsDouble() },
             { "licence", "BSD-3-Clause" },
             { "provenance", "Drawn by SonoVDB from implicit shapes; no patient's." } };
  }
  if (kind == "SonoLabelMapReader" || kind == "SonoMaskFolderReader")
  {
    const vtkSMPropertyHelper file(labels, "FileName");
    const QString name = file.GetNumberOfElements() > 0 ? file.GetAsString(0) : "";
    return { { "id", QFileInfo(name).fileName() },
             { "labels", QFileInfo(name).absoluteFilePath() },
             { "licence", "unknown" },
             { "provenance", "unknown" } };
  }
  return {};
}

} // namespace

QString sonoWriteDataSet(pqPipelineSource* path, pqPipelineSource* ultrasound, const QString& file)
{
  auto* simulated = vtkSMSourceProxy::SafeDownCast(ultrasound->getProxy());
  QJsonObject patient = patientOf(vtkSMPropertyHelper(simulated, "Input").GetAsProxy());
  if (patient.empty())
  {
    return tr("A data set takes the label map straight from its file or from the Thorax Phantom; connect Simulate "
              "Ultrasound to one of these.");
  }
  const std::vector<SonoTimedPose> poses = sonoPathOf(path);
  const QStringList structures = structuresOf(simulated);
  if (structures.empty())
  {
    return tr("The anatomy has no surfaces to name masks by; switch on Build Surfaces and click Apply.");
  }
  patient["views"] = viewsOf(poses);
  const QJsonObject set{
    { "name", "path" },
    { "description", "The poses of a probe that was moved by hand, an image each." },
    { "seed", 1 },
    { "exams", 1 },
    { "imagesPerExam", int(poses.size()) },
    { "patients", QJsonArray{ patient } },
    { "probe", probeOf(simulated) },
    { "tracing", numbersOf(simulated, { "PathsPerLine" }) },
    { "display", numbersOf(simulated, { "GainDb", "DynamicRangeDb", "TgcDbPerCm" }) },
    { "masks", masksOf(structures) },
    { "format", "nnU-Net" },
  };
  QFile out(file);
  if (!out.open(QIODevice::WriteOnly | QIODevice::Truncate) || out.write(QJsonDocument(set).toJson()) < 0)
  {
    return tr("'%1' could not be written: %2.").arg(file, out.errorString());
  }
  return {};
}
