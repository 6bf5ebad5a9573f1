#pragma once

#include "Probe/PulseEchoField.h"

#include <string>

namespace sono {

/// Reads a pulse-echo field from a NRRD file (http://teem.sourceforge.net/nrrd/format.html) of three axes:
/// lateral (fastest), elevational, depth. Its header says
/// \code{.unparsed}
///   labels: "lateral" "elevational" "depth"     these three, in this order
///   units: "mm" "mm" "mm"
///   axis mins: 0 0 0                            position of the first value along each axis; values lie at nodes
///   spacings: 0.25 0.5 1.25                     distance of two values, > 0
/// \endcode
/// and the values are two-way amplitudes (not dB, not power) of at least 0, of any number type and scale; raw, gzip,
/// text or hexadecimal.
/// A lateral or elevational axis that starts at 0 holds half of a symmetric beam. From MATLAB, with w(lateral,
/// elevational, depth) at x, y and z mm, for instance the root mean square of Field II's calc_hhp at each position:
/// \code{.unparsed}
///   f = fopen('field.nrrd', 'w', 'l');
///   fprintf(f, 'NRRD0004\ntype: float\nendian: little\nencoding: raw\ndimension: 3\nsizes: %d %d %d\n', size(w));
///   fprintf(f, 'labels: "lateral" "elevational" "depth"\nunits: "mm" "mm" "mm"\n');
///   fprintf(f, 'axis mins: %.9g %.9g %.9g\n', x(1), y(1), z(1));
///   fprintf(f, 'spacings: %.9g %.9g %.9g\n\n', x(2) - x(1), y(2) - y(1), z(2) - z(1));
///   fwrite(f, w, 'float32'); fclose(f);
/// \endcode
/// Throws Error naming the file, and the axis or the position of the value that is wrong.
PulseEchoField readPulseEchoField(const std::string& path);

/// Writes that format, as raw little-endian float. Throws Error naming the file when it cannot.
void writePulseEchoField(const PulseEchoField& field, const std::string& path);

} // namespace sono
