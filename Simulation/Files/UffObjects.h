#pragma once

#include "Files/Hdf5File.h"
#include "Probe/ArrayElements.h"

#include <string>
#include <vector>

namespace sono {

/// Writes objects of the Ultrasound File Format. MATLAB, whose format it is, names the fastest axis first: [pixel x
/// channel x wave x frame] is frame x wave x channel x pixel here, and [element x 7] is 7 x elements. Names are paths.
class UffObjects
{
public:
  explicit UffObjects(Hdf5File& file)
    : file_(file)
  {
  }

  void object(const std::string& name, const std::string& kind);
  /// Several of a kind, named item() in there.
  void list(const std::string& name, const std::string& kind, std::size_t count);
  static std::string item(const std::string& list, std::size_t number);
  /// What an array or a number is.
  void describe(const std::string& name, const std::string& kind, int isComplex, int isImaginary);
  void words(const std::string& name, const std::string& value);
  void floats(const std::string& name, const Hdf5File::Shape& shape, const std::vector<float>& values);
  void number(const std::string& name, double value) { floats(name, { 1, 1 }, { float(value) }); }
  /// One of an enumeration of this class.
  void choice(const std::string& name, const std::string& kind, int value);
  /// A uff.point, m and rad.
  void point(const std::string& name, double distance, double azimuth);
  /// A uff.probe, and a uff.pulse.
  void probe(const std::string& name, const ArrayElements& elements);
  void pulse(const std::string& name, const ProbeSettings& probe);
  /// Who made it: name, author, info, and of several frames frame_rate or another word for it.
  void header(const std::string& name, const std::vector<double>& timesS, const std::string& rate);

private:
  Hdf5File& file_;
};

} // namespace sono
