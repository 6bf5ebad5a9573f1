#pragma once

#include "Channels/ChannelPoints.h"
#include "Core/Progress.h"
#include "Echo/EchoSettings.h"
#include "Echo/FormRf.h"

namespace sono {

/// What of a scene echoes into an array's channels: the scatterers and surfaces of the picture, as points, within the
/// fan of the probe's lines and 2.5 deviations of the beam across it (Data/docs/physics.md section 15.3). Amplitudes
/// are roots of cross-sections, mm, times the traced intensity there, interpolated between lines; a smooth perfect
/// mirror echoes as its mirror image. Tissues' scatterers are those of the picture, or with fewer candidates a cell a
/// part of them, made stronger. What reverberates, and what lies beside the fan, is silent.
///
/// `sources` have a scene, and traced lines of the probe's at the pose, or none (intensity 1). `echo` are the picture's
/// settings. Throws Error where these do not fit together, and for Amadou2024, whose surfaces are echoes
/// of lines; Aborted.
ChannelPoints scenePoints(const EchoSources& sources, const ProbeSettings& probe, const ProbePose& pose,
                          const EchoSettings& echo, int scatterersPerCell, const Progress& progress = {});

/// Amplitudes of points that are given as echoes on a beam's axis, as roots of cross-sections: A_b / lambda
/// (Data/docs/physics.md eq. 10.8).
double crossSectionPerEcho(const EchoSettings& echo);

} // namespace sono
