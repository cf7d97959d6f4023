// How ground reflects sunlight: laws of photometry, as functions of the cosines m0 of incidence and m of
// emission and of the phase angle a between the directions to the sun and to the viewer.
//
//   lunar-Lambert   L 2 m0 / (m0 + m) + (1 - L) m0; L = 0 is Lambert's (McEwen, Icarus 92, 1991, eq. 3)
//   Minnaert        m0^k m^(k - 1)
//   Akimov          cos(a/2) cos[pi / (pi - a) (g - a/2)] cos(b)^(a / (pi - a)) / cos g
//   ROLO            [C0 exp(-C1 a) + A0 + A1 a + A2 a^2 + A3 a^3 + A4 a^4] m0 / (m0 + m), a in degrees
//   Hapke           w / 4 m0e / (m0e + me) [(1 + B(a)) P(a) + H(m0e) H(me) - 1] S (Icarus 59, 1984)
//
// Akimov's photometric longitude g and latitude b have m0 = cos b cos(a - g) and m = cos b cos g (Shkuratov
// et al. 2011). Hapke's B = B0 / (1 + tan(a/2) / h), P is that of Henyey and Greenstein, H(x) = (1 + 2 x) /
// (1 + 2 x sqrt(1 - w)); m0e, me and S are the tilted cosines and the shadowing of ground of mean slope
// theta.
#pragma once

#include <string>

namespace astrolith {

struct Reflectance {
  enum class Law { kLunarLambert, kMinnaert, kAkimov, kRolo, kHapke };
  Law law = Law::kLunarLambert;
  double lunar_share = 0.35;  // L, 0 .. 1
  double k = 0.7;             // of Minnaert, .1 .. 1
  double w = 0.2;             // single-scattering albedo, above 0, below 1
  double g = -0.3;            // of Henyey and Greenstein, -.95 .. .95; below 0 rock scatters backwards
  double b0 = 0.8, h = 0.05;  // height 0 .. 10 and width .0001 .. 2 of the opposition surge
  double theta = 20.0;        // mean slope below what is meshed, degrees, 0 .. 60
  // The phase curve of ROLO holds the albedo: the normal albedo is (C0 + A0) / 2.
  double c0 = 0.0, c1 = 0.1;
  double a0 = 0.1, a1 = 0.0, a2 = 0.0, a3 = 0.0, a4 = 0.0;
};

// "rock" (L = .35), "lambert", "lommel-seeliger", "akimov", or a law with its numbers: "mcewen L .5",
// "minnaert k .6", "rolo C0 .02 C1 .1 A0 .08 A1 -.001", "hapke w .2 g -.3 b0 .8 h .05 theta 20"; what is left
// out has the value above. "hapke ceres" and "hapke tempel1" have the numbers of a body, which others may
// follow. Throws InputError, naming `name`, for words that say no law and for numbers out of range.
Reflectance parse_reflectance(const std::string& name, const std::string& words);

// The words of parse_reflectance(), for messages.
inline constexpr const char* kReflectanceWords =
    "rock, lambert, lommel-seeliger, akimov, mcewen L N, minnaert k N, hapke w N g N b0 N h N theta "
    "DEGREES, hapke ceres, hapke tempel1, rolo C0 N C1 N A0 N ... A4 N";

// Whether the law has the albedo of the ground in itself, so that its value is I/F: Hapke's and ROLO's.
inline bool is_radiance_factor(const Reflectance& law) {
  return law.law == Reflectance::Law::kHapke || law.law == Reflectance::Law::kRolo;
}

// The law's value at cosines in (0, 1] and a phase angle of 0 .. pi. Of Hapke's and ROLO's laws it is I/F; of
// the others the ratio to ground that is seen and lit from above, whose albedo is 1.
double reflectance_at(const Reflectance& law, double m0, double m, double phase);

// reflectance_at() for cosines as rays meet them. Cosines of emission below a thousandth count as that.
float radiance_factor(const Reflectance& law, float m0, float m, float cos_phase);

// What pictures show of it: laws that are I/F over their own value where ground faces midway between the sun
// and the viewer, times the cosine there. The phase curve and the albedo are left out so that pictures need
// no exposure. Cosines of emission below a thousandth count as that.
float pictured_reflectance(const Reflectance& law, float m0, float m, float cos_phase);

}  // namespace astrolith
