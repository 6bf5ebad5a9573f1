#ifndef SonoParameters_h
#define SonoParameters_h

#include "vtkIOStream.h"
#include "vtkIndent.h"
#include "vtkSonoFiltersModule.h" // for export macro

namespace sono {

/// The parameters of a stage by the names of their properties. A class that has them in `Parameters` declares each by
/// one line, sonoParameter; all else is said in the settings struct of Simulation (see Core/Parameters.h).
class VTKSONOFILTERS_EXPORT ParameterSet
{
public:
  virtual ~ParameterSet();
  /// Whether the value was another one.
  virtual bool set(const char* name, double value) = 0;
  virtual double get(const char* name) const = 0;
  virtual void print(ostream& os, vtkIndent indent) const = 0;
};

} // namespace sono

/// The property `name`; its type is int or double.
#define sonoParameter(name, type)                                                                                      \
  virtual void Set##name(type value)                                                                                   \
  {                                                                                                                    \
    if (this->Parameters->set(#name, static_cast<double>(value)))                                                      \
    {                                                                                                                  \
      this->Modified();                                                                                                \
    }                                                                                                                  \
  }                                                                                                                    \
  virtual type Get##name()                                                                                             \
  {                                                                                                                    \
    return static_cast<type>(this->Parameters->get(#name));                                                            \
  }

/// One that is on or off.
#define sonoSwitch(name)                                                                                               \
  sonoParameter(name, bool);                                                                                           \
  virtual void name##On()                                                                                              \
  {                                                                                                                    \
    this->Set##name(true);                                                                                             \
  }                                                                                                                    \
  virtual void name##Off()                                                                                             \
  {                                                                                                                    \
    this->Set##name(false);                                                                                            \
  }

#endif
