#ifndef pqSonoBiplane_h
#define pqSonoBiplane_h

#include "vtkSmartPointer.h"

#include <QObject>

#include <map>
#include <utility>

class pqPipelineSource;
class vtkSMProxy;
class vtkSMProxyLink;

/**
 * @class pqSonoBiplane
 * @brief Keeps all settings but the plane alike in the two Simulate Ultrasounds of a biplane picture
 *
 * Which are two is seen from their input and planes (SonoSplitScreen.h), so that states and undo hold it. ParaView's
 * own links, of Tools > Manage Links, cannot be undone: it drops all steps of undo when one comes or goes.
 */
class pqSonoBiplane : public QObject
{
  Q_OBJECT
  using Superclass = QObject;

public:
  explicit pqSonoBiplane(QObject* parent = nullptr);
  ~pqSonoBiplane() override;

Q_SIGNALS:
  /// Pairs may have come or gone.
  void changed();

private Q_SLOTS:
  void link();

private:
  Q_DISABLE_COPY(pqSonoBiplane)

  void watch(pqPipelineSource* source);

  std::map<vtkSMProxy*, std::pair<vtkSMProxy*, vtkSmartPointer<vtkSMProxyLink>>>
    links_; // by second plane, with the first
};

#endif
