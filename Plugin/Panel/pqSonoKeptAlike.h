#ifndef pqSonoKeptAlike_h
#define pqSonoKeptAlike_h

#include "vtkSmartPointer.h"

#include <QObject>

#include <map>
#include <vector>

class pqPipelineSource;
class vtkSMLink;
class vtkSMProxy;

/**
 * @class pqSonoKeptAlike
 * @brief Keeps settings alike in Simulate Ultrasounds that belong together
 *
 * Which ones do is seen from their input and a property (SonoSplitScreen.h), so that states and undo hold it.
 * ParaView's own links, of Tools > Manage Links, cannot be undone: it drops all steps of undo when one comes or goes.
 */
class pqSonoKeptAlike : public QObject
{
  Q_OBJECT
  using Superclass = QObject;

public:
  /// All settings but the plane, in the two of a biplane picture.
  static pqSonoKeptAlike* biplane(QObject* parent);
  /// The probe of those who share one, as the two of a split screen.
  static pqSonoKeptAlike* sharedProbe(QObject* parent);
  ~pqSonoKeptAlike() override;

Q_SIGNALS:
  /// Groups may have come or gone.
  void changed();

private Q_SLOTS:
  void link();

private:
  Q_DISABLE_COPY(pqSonoKeptAlike)

  using Group = std::vector<vtkSMProxy*>;
  using Links = std::vector<vtkSmartPointer<vtkSMLink>>;

  pqSonoKeptAlike(const char* property, std::vector<Group> (*groups)(), Links (*linksOf)(const Group&),
                  QObject* parent);
  static Links linksOfPlanes(const Group& planes);
  static Links linksOfProbe(const Group& sharers);
  void watch(pqPipelineSource* source);

  const char* property_; // that says who belongs together
  std::vector<Group> (*groups_)();
  Links (*linksOf_)(const Group&);
  std::map<Group, Links> links_;
};

#endif
