#include "SonoStore.h"

#include "pqUndoStack.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMWriterProxy.h"
#include "vtkSmartPointer.h"
#include "vtkSonoUltrasound.h"

#include <QCoreApplication>

QString sonoStorePicture(vtkSMSourceProxy* ultrasound, const QString& file)
{
  constexpr auto port = static_cast<unsigned int>(vtkSonoUltrasound::FLAT_IMAGE);
  const int* extent = ultrasound->GetDataInformation(port)->GetExtent();
  if (extent[1] < extent[0])
  {
    return QCoreApplication::translate("SonoStore", "There is no picture yet; click Apply first.");
  }
  if (extent[5] > extent[4])
  {
    return QCoreApplication::translate(
      "SonoStore", "A matrix probe makes a volume, which is no picture; save it by File > Save Data.");
  }
  SCOPED_UNDO_EXCLUDE(); // a writer comes and goes
  const auto writer = vtkSmartPointer<vtkSMWriterProxy>::Take(
    vtkSMWriterProxy::SafeDownCast(ultrasound->GetSessionProxyManager()->NewProxy("writers", "EchoPictureWriter")));
  SM_SCOPED_TRACE(SaveData)
    .arg("writer", writer)
    .arg("filename", file.toUtf8().data())
    .arg("source", ultrasound)
    .arg("port", static_cast<int>(port));
  vtkSMPropertyHelper(writer, "FileName").Set(file.toUtf8().data());
  vtkSMPropertyHelper(writer, "Input").Set(ultrasound, port);
  writer->UpdateVTKObjects();
  writer->UpdatePipeline();
  return {};
}
