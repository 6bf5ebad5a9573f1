#pragma once

#include "Core/Parameters.h"

#include <cstdint>

namespace sono {

/// What tells one body of the bundled family from another. The defaults are the phantom as it always was. Volumes and
/// thickness are those at the end of diastole, whatever the phase; volumes of blood, without papillary muscles and
/// leaflets; of the valves' opening the phase takes its share (BeatingHeart.h).
///
/// Published: Lang et al., "Recommendations for cardiac chamber quantification by echocardiography in adults", JASE
/// 2015;28:1-39, gives as normal at end-diastole 46 to 150 ml for the left ventricle (both sexes) and walls of 6 to 10
/// mm, and 16 to 34 ml per square metre of body for the left atrium at its largest, and 52 to 74 % as the left
/// ventricle's ejection fraction, down to below 30 in disease. The ranges below go beyond them, to dilated and
/// hypertrophic hearts.
///
/// On the left side, for which echocardiography turns its patients, the apex goes by 15 mm and the base stays
/// ("Inconsistency in LVOT measurement between cardiac computed tomography, magnetic resonance imaging and 3D
/// echocardiography", abstract). The left lung's edge then lies 25 mm beside the sternum, as Gray (Anatomy of the Human
/// Body, 1918) draws the cardiac notch at the fourth costal cartilage, and this from the sixth up to the second rib,
/// since the parasternal window is the second or third space. Chosen: how high, and that it keeps 30 mm off the heart's
/// front, which is then free of lung up to the chest's side. The apex swings along the chest wall, about the aortic
/// valve; liver and stomach stay.
struct ThoraxParameters
{
  double leftVentricleMl = 91.6;
  double rightVentricleMl = 108.2;
  double leftAtriumMl = 51.2;
  double rightAtriumMl = 73.3;
  double wallThicknessMm = 10.0;
  double valveOpening = 0.4;
  double heartLeftMm = 0.0;
  double heartBackMm = 0.0;
  double heartUpMm = 0.0;
  double extraFatMm = 0.0;
  double bodyScale = 1.0;
  double ribSpacingMm = 29.0;
  double lungOverlapMm = 0.0;
  double breathing = 0.0;
  double leftLateral = 0.0;
  double phase = 0.0;
  double ejectionPercent = 60.0;

  template<class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor(self.leftVentricleMl, Parameter{ "leftVentricleMl", "Left Ventricle (ml)", between(60, 220),
                                             "Blood in the left ventricle at end-diastole in ml, 60 to 220." });
    visitor(self.rightVentricleMl, Parameter{ "rightVentricleMl", "Right Ventricle (ml)", between(60, 200),
                                              "Blood in the right ventricle at end-diastole in ml, 60 to 200." });
    visitor(self.leftAtriumMl, Parameter{ "leftAtriumMl", "Left Atrium (ml)", between(25, 110),
                                          "Blood in the left atrium in ml, 25 to 110." });
    visitor(self.rightAtriumMl, Parameter{ "rightAtriumMl", "Right Atrium (ml)", between(30, 120),
                                           "Blood in the right atrium in ml, 30 to 120." });
    visitor(self.wallThicknessMm,
            Parameter{ "wallThicknessMm", "Wall Thickness (mm)", between(6, 18),
                       "Mean thickness of the left ventricle's wall at its sides in mm, 6 to 18." });
    visitor(self.valveOpening,
            Parameter{ "valveOpening", "Valve Opening", between(0, 0.7),
                       "Radius between the tips of the mitral and tricuspid leaflets over the ring's, "
                       "0 (closed) to 0.7." });
    visitor(self.heartLeftMm, Parameter{ "heartLeftMm", "Heart Left (mm)", between(-20, 20),
                                         "Shift of the heart to the left in mm, -20 to 20." });
    visitor(self.heartBackMm, Parameter{ "heartBackMm", "Heart Back (mm)", between(-20, 20),
                                         "Shift of the heart to the back in mm, -20 to 20." });
    visitor(self.heartUpMm, Parameter{ "heartUpMm", "Heart Up (mm)", between(-20, 20),
                                       "Shift of the heart to the head in mm, -20 to 20." });
    visitor(self.extraFatMm, Parameter{ "extraFatMm", "Extra Fat (mm)", between(0, 30),
                                        "Subcutaneous fat beyond the usual 6 to 7 mm in mm, 0 to 30." });
    visitor(self.bodyScale, Parameter{ "bodyScale", "Body Scale", between(0.95, 1.2),
                                       "Width and depth of the chest over the usual ones, 0.95 to 1.2." });
    visitor(self.ribSpacingMm, Parameter{ "ribSpacingMm", "Rib Spacing (mm)", between(24, 34),
                                          "Distance of a rib's centre to the next one's in mm, 24 to 34; the fifth "
                                          "intercostal space stays where it is." });
    visitor(self.lungOverlapMm, Parameter{ "lungOverlapMm", "Lung Overlap (mm)", between(0, 30),
                                           "How far the lungs' edges come in over the heart in mm, 0 to 30." });
    visitor(self.breathing,
            Parameter{ "breathing", "Breathing", between(0, 1),
                       "0: breathed out, 1: deeply in, with the diaphragm 35 mm and the heart 10 mm lower." });
    visitor(self.leftLateral,
            Parameter{ "leftLateral", "Left Lateral", between(0, 1),
                       "0: supine, 1: on the left side, with the apex 15 mm further left and the left lung's edge 25 "
                       "mm beside the sternum." });
    visitor(self.phase,
            Parameter{ "phase", "Phase", between(0, 1),
                       "Of the heart's cycle, 0 to 1, from the end of diastole on; systole ends at 0.35." });
    visitor(self.ejectionPercent, Parameter{ "ejectionPercent", "Ejection (%)", between(15, 62),
                                             "Share of its blood that the left ventricle ejects in %, 15 to 62." });
  }
};

} // namespace sono
