#ifndef pqSonoSharedProbe_h
#define pqSonoSharedProbe_h

#include "vtkSmartPointer.h"

#include <QObject>

#include <map>
#include <vector>

class pqPipelineSource;
class vtkSMPropertyLink;
class vtkSMProxy;

/**
 * @class pqSonoSharedProbe
 * @brief Keeps the probe of Simulate Ultrasounds alike that share one, as those of a split screen
 *
 * Which ones do is seen from their input and their property SharedProbe (SonoSplitScreen.h), so that states and undo
 * hold it; pqSonoBiplane.h says why these are no links of Tools > Manage Links.
 */
class pqSonoSharedProbe : public QObject
{
  Q_OBJECT
  using Superclass = QObject;

public:
  explicit pqSonoSharedProbe(QObject* parent = nullptr);
  ~pqSonoSharedProbe() override;

private Q_SLOTS:
  void link();

private:
  Q_DISABLE_COPY(pqSonoSharedProbe)

  void watch(pqPipelineSource* source);

  using Links = std::vector<vtkSmartPointer<vtkSMPropertyLink>>; // one for each property
  std::map<std::vector<vtkSMProxy*>, Links> links_;              // of those who share a probe
};

#endif
