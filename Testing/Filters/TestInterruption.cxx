// What a stop by the interrupter, a GUI's button, leaves behind.
#include "Simulation/TemporaryFolder.h"
#include "SonoInterruption.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSonoBMode.h"
#include "vtkSonoImageFormation.h"
#include "vtkSonoProbeSource.h"
#include "vtkSonoRayTracer.h"
#include "vtkSonoScanConverter.h"
#include "vtkSonoSceneBuilder.h"
#include "vtkSonoSceneWriter.h"
#include "vtkSonoThoraxSource.h"
#include "vtkSonoUltrasound.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace {

/// Presses the button when it was asked so many times.
class Button : public sono::Interrupter
{
public:
  Button() { sono::setInterrupter(this); }
  ~Button() override { sono::setInterrupter(nullptr); }
  bool wantsStop() override { return ++asked > allowed; }
  void hasStopped(vtkAlgorithm* filter) override { stopped.push_back(filter); }
  void hasFinished(vtkAlgorithm* filter) override { finished.push_back(filter); }
  void pressAfter(int times)
  {
    asked = 0;
    allowed = times;
  }
  void leaveAlone() { allowed = 1 << 30; }

  std::vector<vtkAlgorithm*> stopped;
  std::vector<vtkAlgorithm*> finished;
  int asked = 0;

private:
  int allowed = 1 << 30;
};

class Counter : public vtkCommand
{
public:
  static Counter* New() { return new Counter; }
  void Execute(vtkObject*, unsigned long, void*) override { ++count; }
  int count = 0;
};

std::vector<double> greys(vtkImageData* image)
{
  vtkDataArray* array = image->GetPointData()->GetArray("BMode");
  std::vector<double> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(array->GetTuple1(i));
  }
  return values;
}

/// All stages from a coarse thorax on.
struct Chain
{
  vtkNew<vtkSonoThoraxSource> thorax;
  vtkNew<vtkSonoSceneBuilder> scene;
  vtkNew<vtkSonoProbeSource> probe;
  vtkNew<vtkSonoRayTracer> tracer;
  vtkNew<vtkSonoImageFormation> formation;
  vtkNew<vtkSonoBMode> bmode;
  vtkNew<vtkSonoScanConverter> converter;
  vtkNew<Counter> errors;

  Chain()
  {
    thorax->SetSpacingMm(4.0);
    scene->SetInputConnection(thorax->GetOutputPort());
    scene->SetBuildSurfaces(false);
    probe->SetLineCount(24);
    tracer->SetInputConnection(0, scene->GetOutputPort());
    tracer->SetInputConnection(1, probe->GetOutputPort());
    tracer->SetPathsPerLine(20);
    formation->SetInputConnection(tracer->GetOutputPort());
    bmode->SetInputConnection(formation->GetOutputPort());
    converter->SetInputConnection(bmode->GetOutputPort());
    for (vtkAlgorithm* stage :
         std::initializer_list<vtkAlgorithm*>{ thorax, scene, probe, tracer, formation, bmode, converter })
    {
      stage->AddObserver(vtkCommand::ErrorEvent, errors);
      stage->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
    }
  }

  std::vector<double> picture()
  {
    converter->Update();
    return greys(converter->GetOutput());
  }
};

TEST(Interruption, TheDataOfBeforeStayUntilSomethingChanges)
{
  Button button;
  Chain chain;
  const std::vector<double> before = chain.picture();
  ASSERT_FALSE(before.empty());

  chain.tracer->SetPathsPerLine(40);
  button.pressAfter(3);
  EXPECT_EQ(chain.picture(), before);
  // What follows has made its results of these very data and has nothing to stop.
  EXPECT_EQ(button.stopped, std::vector<vtkAlgorithm*>{ chain.tracer });

  button.leaveAlone();
  EXPECT_EQ(chain.picture(), before); // no second try by itself
  chain.tracer->Modified();
  const std::vector<double> after = chain.picture();
  EXPECT_NE(after, before);
  EXPECT_EQ(chain.errors->count, 0);

  Chain fresh;
  fresh.tracer->SetPathsPerLine(40);
  EXPECT_EQ(fresh.picture(), after);
}

TEST(Interruption, AFirstRunLeavesNothingAndIsQuiet)
{
  Button button;
  for (vtkAlgorithm* (*which)(Chain&) : { +[](Chain& chain) -> vtkAlgorithm* { return chain.tracer; },
                                          +[](Chain& chain) -> vtkAlgorithm* { return chain.scene; } })
  {
    Chain chain;
    button.stopped.clear();
    vtkAlgorithm* stage = which(chain);
    for (int port = 0; port < stage->GetNumberOfInputPorts(); ++port)
    {
      if (stage->GetNumberOfInputConnections(port) > 0)
      {
        stage->GetInputAlgorithm(port, 0)->Update();
      }
    }
    button.pressAfter(0);
    EXPECT_TRUE(chain.picture().empty());
    EXPECT_EQ(button.stopped, std::vector<vtkAlgorithm*>{ stage });
    button.leaveAlone();
    for (int update = 0; update < 3; ++update)
    {
      EXPECT_TRUE(chain.picture().empty());
    }
    EXPECT_EQ(button.stopped.size(), 1u);
    stage->Modified();
    EXPECT_FALSE(chain.picture().empty());
    EXPECT_EQ(chain.errors->count, 0);
  }
}

TEST(Interruption, ADeeperImageThatWasStoppedIsNotTriedAgain)
{
  Button button;
  Chain chain;
  const std::vector<double> before = chain.picture();
  chain.probe->SetDepthMm(200.0); // another extent
  button.pressAfter(3);
  chain.picture();
  button.leaveAlone();
  button.stopped.clear();
  button.finished.clear();
  chain.picture();
  EXPECT_TRUE(button.stopped.empty());
  for (vtkAlgorithm* filter : button.finished)
  {
    EXPECT_NE(filter, chain.tracer);
  }
  chain.tracer->Modified();
  EXPECT_NE(chain.picture(), before);
  EXPECT_EQ(chain.errors->count, 0);
}

TEST(Interruption, TheOneFilterStopsInAnyOfItsStages)
{
  Button button;
  vtkNew<vtkSonoThoraxSource> thorax;
  thorax->SetSpacingMm(4.0);
  vtkNew<vtkSonoUltrasound> ultrasound;
  ultrasound->SetInputConnection(thorax->GetOutputPort());
  ultrasound->GetProbe()->SetLineCount(24);
  ultrasound->GetRayTracer()->SetPathsPerLine(20);
  const auto picture = [&] {
    ultrasound->Update();
    return greys(ultrasound->GetOutput());
  };
  const std::vector<double> before = picture();
  ASSERT_FALSE(before.empty());
  for (const bool inTheScene : { false, true })
  {
    button.stopped.clear();
    ultrasound->GetRayTracer()->SetPathsPerLine(40);
    ultrasound->GetSceneBuilder()->SetFillBody(inTheScene);
    button.pressAfter(2);
    EXPECT_EQ(picture(), before);
    EXPECT_EQ(button.stopped, std::vector<vtkAlgorithm*>{ ultrasound });
    button.leaveAlone();
    EXPECT_EQ(picture(), before);
    ultrasound->Modified();
    EXPECT_NE(picture(), before);
    ultrasound->GetRayTracer()->SetPathsPerLine(20);
    ultrasound->GetSceneBuilder()->SetFillBody(false);
    EXPECT_EQ(picture(), before);
  }
}

TEST(Interruption, ASceneWhoseWritingIsStoppedIsNotThere)
{
  const sono::testing::TemporaryFolder folder;
  const std::string path = folder.file("stopped.nvdb");
  Button button;
  Chain chain;
  vtkNew<Counter> warnings;
  vtkNew<vtkSonoSceneWriter> writer;
  writer->SetInputConnection(chain.scene->GetOutputPort());
  writer->SetFileName(path.c_str());
  writer->AddObserver(vtkCommand::WarningEvent, warnings);
  chain.scene->Update();
  button.pressAfter(2);
  writer->Write();
  EXPECT_EQ(writer->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::CannotOpenFileError));
  EXPECT_EQ(warnings->count, 1);
  EXPECT_FALSE(std::filesystem::exists(path));
  button.leaveAlone();
  writer->Write();
  EXPECT_EQ(writer->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
  EXPECT_EQ(warnings->count, 1);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(Interruption, ALongLineStopsInItsMiddle)
{
  Button button;
  Chain chain;
  chain.probe->SetLineCount(1);
  chain.tracer->SetPathsPerLine(100000);
  button.leaveAlone();
  chain.scene->Update();
  button.pressAfter(1 << 30);
  chain.tracer->Update();
  const int whole = button.asked;
  chain.tracer->SetPathSeed(2);
  button.pressAfter(20);
  chain.tracer->Update();
  EXPECT_LT(button.asked, whole / 3);
  EXPECT_EQ(button.stopped.size(), 1u);
}

} // namespace
