#include "Echo/SurfaceRows.h"

#include "Core/KeptByNumbers.h"
#include "Core/SoundSpeed.h"
#include "Echo/Pulse.h"
#include "Scene/SurfacePieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sono {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int nodes = 162;
constexpr double perTangent = 32.0; // up to 78.7 degrees
constexpr double mixtureUpTo = 10.0;
constexpr double bandReach = 2.8; // deviations of the pulse's spectrum
/// Of the centre frequency (chosen); what a Gaussian spectrum has below, no transducer passes. A wall along the beam
/// would echo by that alone, and the more so the wider the band is.
constexpr double leastShare = 0.16;
constexpr double nothing = -80.0;    // log of an amplitude
constexpr double leastBeside = 3e-3; // coherent power that counts beside the diffuse one
constexpr double largePiece = 16.0;  // squares of its blob
constexpr double negligible = 1e-9;  // of a sum

/// The surface that counts of two, the rougher.
const Tissue& rougher(const Tissue& a, const Tissue& b)
{
  return a.roughnessMm >= b.roughnessMm ? a : b;
}

/// Diffuse cross-section per area for r = 1, eq. 10.7 with the beam's own range of directions (10.10); where the
/// roughness is small against the wavelength, the mixture of (10.12). Averaged over the pulse's band: aslant, what is
/// heard of a surface of small slopes is the band's lower half.
class Roughness
{
public:
  Roughness(const Tissue& tissue, double radPerMm, const BeamExtent& beam, double bandShare)
    : heightRad_(radPerMm * tissue.roughnessMm)
    , bandShare_(bandShare)
    , perCorrelation_(std::pow(2.0 / (radPerMm * tissue.correlationMm), 2))
    , beamL_(1.0 / std::pow(radPerMm * beam.lateralSigmaMm, 2))
    , beamE_(1.0 / std::pow(radPerMm * beam.elevationalSigmaMm, 2))
  {
  }

  /// The tilt in the lateral or the elevational direction.
  double crossSection(double tangent, bool lateral) const
  {
    constexpr int bandNodes = 9;
    const double lowest = std::max(-bandReach, (leastShare - 1.0) / bandShare_); // deviations from the centre
    double sum = 0.0;
    double weights = 0.0;
    for (int i = 0; i < bandNodes; ++i)
    {
      const double x = lowest + (bandReach - lowest) * i / (bandNodes - 1);
      const double share = 1.0 + x * bandShare_; // of the centre frequency
      weights += std::exp(-x * x);
      sum += std::exp(-x * x) * at(share * share, tangent, lateral);
    }
    return sum / weights;
  }

private:
  /// At the centre frequency times the root of `f2`, times the square of the wavelength there over the centre's.
  double at(double f2, double tangent, bool lateral) const
  {
    const double cosSquared = 1.0 / (1.0 + tangent * tangent);
    const double height2 = heightRad_ * heightRad_ * f2;
    const double g = height2 * cosSquared;
    double sum = 0.0;
    if (height2 >= mixtureUpTo)
    {
      sum = -std::expm1(-g) * lobe(height2, f2, tangent, lateral);
    }
    else
    {
      double poisson = std::exp(-g);
      for (int n = 1; n <= 40; ++n)
      {
        poisson *= g / n;
        const double term = poisson * lobe(n / cosSquared, f2, tangent, lateral);
        sum += term;
        if (term < negligible * sum)
        {
          break; // terms rise, and then fall for good
        }
      }
    }
    return sum / (4.0 * pi * cosSquared * cosSquared * f2);
  }

  /// alpha^2 = n / (k l cos t)^2: aslant, heights count by their cosine, and so do slopes
  double lobe(double n, double f2, double tangent, bool lateral) const
  {
    const double alphaL = (n * perCorrelation_ + beamL_) / f2;
    const double alphaE = (n * perCorrelation_ + beamE_) / f2;
    return std::exp(-tangent * tangent / (lateral ? alphaL : alphaE)) / std::sqrt(alphaL * alphaE);
  }

  double heightRad_; // 2 k h
  double bandShare_; // s_f / f0
  double perCorrelation_;
  double beamL_; // 1 / (4 k^2 s^2)
  double beamE_;
};

/// Half the log of a coherent echo's loss of power across a surface of this roughness, 2 k h: the mean of exp(-(2 k
/// h)^2) over the pulse's band, whose lower half loses far less than its centre.
double coherentLoss(double heightRad, double bandShare)
{
  const double g = heightRad * heightRad;
  const double spread = 1.0 + g * bandShare * bandShare;
  return 0.5 * (g / spread + 0.5 * std::log(spread));
}

double logAmplitude(double crossSection, double scale)
{
  return crossSection > 0.0 ? std::max(nothing, 0.5 * std::log(crossSection) + std::log(scale)) : nothing;
}

} // namespace

BeamExtent beamExtent(const BeamModel& beams)
{
  const BeamWidth focus = beams.focusWidth();
  return { beams.focusAreaMm2(), focus.lateralSigmaMm, focus.elevationalSigmaMm };
}

SurfaceRows::SurfaceRows(const SurfaceMedia& surfaceMedia, const EchoSettings& settings, const BeamExtent& beam,
                         double finestMm, double widestMm)
  : count_(int(surfaceMedia.all.size()))
  , perBeamArea_(1.0 / beam.areaMm2)
  , pulseSigmaMm_(pulseSigmaMm(settings.centreFrequencyMHz, settings.fractionalBandwidth))
  , isShaped_(std::any_of(surfaceMedia.all.begin(), surfaceMedia.all.end(),
                          [](const Tissue& tissue) { return tissue.tau != 1.0 || tissue.gamma != 0.0; }))
  , rows_(2 * surfaceMedia.all.size() * surfaceMedia.all.size())
{
  const std::vector<Tissue>& media = surfaceMedia.all;
  const double radPerMm = 4.0 * pi * settings.centreFrequencyMHz / assumedSoundSpeedMmPerUs; // 2 k
  const double bandShare = 1.0 / (radPerMm * pulseSigmaMm_);                                 // s_f / f0
  const double lambdaMm = assumedSoundSpeedMmPerUs / settings.centreFrequencyMHz;
  // Media of the same roughness share a profile.
  std::vector<int> profileOf;
  std::vector<int> owner;
  for (std::size_t m = 0; m < media.size(); ++m)
  {
    const auto same = std::find_if(owner.begin(), owner.end(), [&](int o) {
      return media[std::size_t(o)].roughnessMm == media[m].roughnessMm &&
             media[std::size_t(o)].correlationMm == media[m].correlationMm;
    });
    profileOf.push_back(int(same - owner.begin()));
    if (same == owner.end())
    {
      owner.push_back(int(m));
      const Roughness roughness(media[m], radPerMm, beam, bandShare);
      for (int n = 0; n < nodes; ++n)
      {
        const double tangent = n / perTangent;
        diffuseL_.push_back(float(logAmplitude(roughness.crossSection(tangent, true), lambdaMm / beam.areaMm2)));
        diffuseE_.push_back(float(logAmplitude(roughness.crossSection(tangent, false), lambdaMm / beam.areaMm2)));
        diffuseMost_.push_back(std::max(diffuseL_.back(), diffuseE_.back()));
      }
      for (std::size_t n = diffuseMost_.size() - 1; n > diffuseMost_.size() - nodes; --n)
      {
        diffuseMost_[n - 1] = std::max(diffuseMost_[n - 1], diffuseMost_[n]);
      }
    }
  }
  for (int a = 0; a < count_; ++a)
  {
    for (int b = 0; b < count_; ++b)
    {
      SurfaceRow& out = rows_[std::size_t(row(a, b))];
      out = {};
      out.reach = -1.0f;
      out.coherentReach = -1.0f;
      out.finestReach = -1.0f;
      out.roughCosine = 2.0f;
      const bool isWithinRod =
        std::find(surfaceMedia.rods.begin(), surfaceMedia.rods.end(), a) != surfaceMedia.rods.end();
      if (a == b || a == surfaceMedia.coupling || isWithinRod)
      {
        continue;
      }
      const Tissue& before = media[std::size_t(a)];
      const Tissue& behind = media[std::size_t(b)];
      const bool ownsRoughness = rougher(before, behind).roughnessMm == before.roughnessMm;
      out.impedanceBefore = float(before.impedanceMRayl);
      out.impedanceBehind = float(behind.impedanceMRayl);
      out.speedRatio = float(behind.soundSpeedMPerS / before.soundSpeedMPerS);
      const double r =
        std::abs(behind.impedanceMRayl - before.impedanceMRayl) / (behind.impedanceMRayl + before.impedanceMRayl);
      out.logDiffuse = float(std::max(nothing, std::log(std::max(r, 1e-300))));
      out.roughness = float(coherentLoss(radPerMm * rougher(before, behind).roughnessMm, bandShare));
      out.decayPerMm = float(decayPerMm(before, settings.centreFrequencyMHz));
      out.tau = float(behind.tau);
      out.gamma = float(behind.gamma);
      out.profile = profileOf[std::size_t(ownsRoughness ? a : b)];
      // Up to where a large piece, seen on the axis, still counts.
      const auto counts = [&](double blobMm, double tangent) {
        const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
        const double spread = std::pow(blobMm * tangent * cosine, 2);
        const double pulse = pulseSigmaMm_ * pulseSigmaMm_;
        const double coherent =
          std::abs(surfaceReflection(out, float(cosine))) * cosine *
          std::exp(-out.roughness * cosine * cosine - 0.5 * radPerMm * radPerMm * spread * pulse / (pulse + spread));
        return coherent * largePiece * blobMm * blobMm * perBeamArea_ > surfaceFaintest;
      };
      // All facets of a wire echo, however they face.
      const bool isOfTarget = std::max(a, b) >= surfaceMedia.tissues;
      // A plane's coherent echo, eq. 10.6, for a beam half as wide as at its focus, against its diffuse one.
      const auto isHeardBeside = [&](double diffuse, double tangent) {
        const double cosSquared = 1.0 / (1.0 + tangent * tangent);
        const double r = surfaceReflection(out, float(std::sqrt(cosSquared)));
        const double depth = std::pow(0.5 * beam.lateralSigmaMm * tangent, 2);
        const double pulse = pulseSigmaMm_ * pulseSigmaMm_;
        const double echoed = pulse / (pulse + depth); // its frequency, of the centre's
        const double power =
          r * r * pulse / (pulse + depth) *
          std::exp(-2.0 * out.roughness * cosSquared - radPerMm * radPerMm * depth * pulse / (pulse + depth));
        return (echoed > leastShare || isOfTarget) &&
               power > leastBeside * diffuse * diffuse * pi * beam.lateralSigmaMm * beam.elevationalSigmaMm;
      };
      for (int n = 0; n < nodes - 1; ++n)
      {
        const double tangent = n / perTangent;
        const std::size_t at = std::size_t(out.profile) * nodes + std::size_t(n);
        const double diffuse = std::exp(double(out.logDiffuse) + std::max(diffuseL_[at], diffuseE_[at]));
        const float next = float(std::min(n + 1.0, nodes - 1.5) / perTangent);
        out.reach = diffuse * std::sqrt(largePiece) * widestMm > surfaceFaintest ? next : out.reach;
        const bool isHeard = isHeardBeside(diffuse, tangent);
        out.coherentReach = isHeard && counts(widestMm, tangent) ? next : out.coherentReach;
        out.finestReach = isHeard && counts(finestMm, tangent) ? next : out.finestReach;
      }
      out.finestReach = std::max(out.finestReach, out.coherentReach);
      const double steepest = std::max(out.reach, out.finestReach) + surfaceTangentSlack;
      out.roughCosine = float(std::cos(std::min(0.5 * pi, std::atan(steepest) + roughNormalRad)));
    }
  }
}

SurfaceTable SurfaceRows::view(double slackMm) const
{
  SurfaceTable table;
  table.rows = rows_.data();
  table.diffuseL = diffuseL_.data();
  table.diffuseE = diffuseE_.data();
  table.nodes = nodes;
  table.perTangent = float(perTangent);
  table.perBeamArea = float(perBeamArea_);
  table.slackMm = float(slackMm);
  table.pulseSigmaMm = float(pulseSigmaMm_);
  table.isShaped = isShaped_;
  return table;
}

std::shared_ptr<const SurfaceRows> sharedSurfaceRows(const SurfaceMedia& media, const EchoSettings& settings,
                                                     const BeamExtent& beam, double finestMm, double widestMm)
{
  // All that the constructor looks at.
  std::vector<double> key{ double(media.coupling),
                           double(media.tissues),
                           double(media.rods.size()),
                           settings.centreFrequencyMHz,
                           settings.fractionalBandwidth,
                           beam.areaMm2,
                           beam.lateralSigmaMm,
                           beam.elevationalSigmaMm,
                           finestMm,
                           widestMm };
  for (const Tissue& t : media.all)
  {
    key.insert(key.end(), { t.impedanceMRayl, t.soundSpeedMPerS, t.attenuationDbPerCmMHz, t.tau, t.gamma, t.roughnessMm,
                            t.correlationMm });
  }
  key.insert(key.end(), media.rods.begin(), media.rods.end());
  static KeptByNumbers<SurfaceRows> kept(64); // of a data set's workers some each
  return kept.of(std::move(key), [&] { return SurfaceRows(media, settings, beam, finestMm, widestMm); });
}

} // namespace sono
