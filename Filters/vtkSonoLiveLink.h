#ifndef vtkSonoLiveLink_h
#define vtkSonoLiveLink_h

#include "vtkImageAlgorithm.h"
#include "vtkSonoFiltersModule.h" // for export macro

#include <memory>
#include <string>

namespace sono {
class LiveLink;
struct LinkState;
}

/**
 * @class vtkSonoLiveLink
 * @brief Shows an ultrasound image to 3D Slicer, PLUS and others as it is made, and takes poses from them
 *
 * Takes an image that carries its probe, as vtkSonoDicomWriter does, of one slice, and passes it on. An OpenIGTLink
 * server sends it, each time that it changes, as sono::LiveLink says. Who owns the probe asks for GetReceivedCount and
 * moves it to GetReceivedPose; in ParaView the plugin does.
 */
class VTKSONOFILTERS_EXPORT vtkSonoLiveLink : public vtkImageAlgorithm
{
public:
  static vtkSonoLiveLink* New();
  vtkTypeMacro(vtkSonoLiveLink, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether others can connect. Default on.
   */
  vtkSetMacro(Active, bool);
  vtkGetMacro(Active, bool);
  vtkBooleanMacro(Active, bool);
  ///@}

  ///@{
  /**
   * TCP port, 1 to 65535; 0: any that is free, see GetOpenPort. Default 18944, OpenIGTLink's.
   */
  vtkSetMacro(Port, int);
  vtkGetMacro(Port, int);
  ///@}

  ///@{
  /**
   * Whether other computers may connect, too: all that reach the port, since OpenIGTLink has no passwords. Default off.
   */
  vtkSetMacro(OtherComputers, bool);
  vtkGetMacro(OtherComputers, bool);
  vtkBooleanMacro(OtherComputers, bool);
  ///@}

  ///@{
  /**
   * Name of the transform that says where the probe is, up to 20 characters. Default "ProbeToReference".
   */
  vtkSetStdStringFromCharMacro(Transform);
  vtkGetCharFromStdStringMacro(Transform);
  ///@}

  /**
   * The port that is open; 0: none.
   */
  int GetOpenPort() const;
  /**
   * A sentence: who is connected and what went wrong last.
   */
  const char* GetStatus();
  /**
   * How many poses came since the port was opened.
   */
  int GetReceivedCount() const;
  /**
   * The newest: position, axial and lateral direction of the probe, LPS mm.
   */
  double* GetReceivedPose() VTK_SIZEHINT(9);

protected:
  vtkSonoLiveLink();
  ~vtkSonoLiveLink() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSonoLiveLink(const vtkSonoLiveLink&) = delete;
  void operator=(const vtkSonoLiveLink&) = delete;

  void Open();

  bool Active = true;
  int Port = 18944;
  bool OtherComputers = false;
  std::string Transform = "ProbeToReference";
  std::unique_ptr<sono::LiveLink> Link; // while others can connect
  std::string Opened;                   // with which settings
  std::string Status;
  double ReceivedPose[9] = { 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0 };
};

#endif
