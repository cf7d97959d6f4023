#include "synthesis/picture/reflectance.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string_view>

#include "numerics/errors.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kLeastCosine = 1e-3f;

double arc_cosine(double c) {
  const double cosine = std::clamp(c, -1.0, 1.0);
  return portable::atan2(std::sqrt(1.0 - cosine * cosine), cosine);
}

double minnaert(double k, double m0, double m) { return portable::pow(m0, k) * portable::pow(m, k - 1.0); }

// At opposition the disk is flat. The other end, where the sun stands behind the body, is dark.
double akimov(double m0, double m, double phase) {
  constexpr double kSmall = 1e-4;
  if (phase < kSmall) return 1.0;
  if (phase > kPi - kSmall) return 0.0;
  const double g = portable::atan2(m0 / m - portable::cos(phase), portable::sin(phase));
  const double cos_g = portable::cos(g), cos_b = std::min(1.0, m / cos_g);
  const double along = portable::cos(kPi / (kPi - phase) * (g - 0.5 * phase));
  if (along <= 0.0) return 0.0;
  return portable::cos(0.5 * phase) * along * portable::pow(cos_b, phase / (kPi - phase)) / cos_g;
}

// Ground of a mean slope, Hapke 1984, equations 45 to 58.
class RoughGround {
 public:
  RoughGround(double theta, double m0, double m, double phase) {
    tan_ = portable::tan(theta);
    chi_ = 1.0 / std::sqrt(1.0 + kPi * tan_ * tan_);
    const Slant i = slant(m0), e = slant(m);
    const double sines = i.sine * e.sine;
    const double cos_psi =
        sines > 1e-12 ? std::clamp((portable::cos(phase) - m0 * m) / sines, -1.0, 1.0) : 1.0;
    const double psi = arc_cosine(cos_psi), half = 0.5 * (1.0 - cos_psi);  // sin^2(psi / 2)
    const bool sun_is_higher = m0 >= m;
    const Slant &low = sun_is_higher ? e : i, &high = sun_is_higher ? i : e;
    const double below = 2.0 - low.e1 - psi / kPi * high.e1;
    // The direction nearer to the ground is tilted by itself, and the other by what it sees of it.
    const double near = chi_ * (low.cosine + low.sine * tan_ * (low.e2 - half * high.e2) / below);
    const double far = chi_ * (high.cosine + high.sine * tan_ * (cos_psi * low.e2 + half * high.e2) / below);
    m0_ = sun_is_higher ? far : near;
    m_ = sun_is_higher ? near : far;
    const double apart = psi > kPi - 1e-9 ? 0.0 : portable::exp(-2.0 * portable::tan(0.5 * psi));
    const double lit = high.cosine / lone(high);
    shadowing_ = m_ / lone(e) * (m0 / lone(i)) * chi_ / (1.0 - apart + apart * chi_ * lit);
  }

  double m0() const { return m0_; }
  double m() const { return m_; }
  double shadowing() const { return shadowing_; }

 private:
  struct Slant {
    double cosine, sine, e1, e2;
  };
  Slant slant(double cosine) const {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    if (sine < 1e-9) return {cosine, sine, 0.0, 0.0};
    const double cotangents = cosine / sine / tan_;
    return {cosine, sine, portable::exp(-2.0 / kPi * cotangents),
            portable::exp(-cotangents * cotangents / kPi)};
  }
  // The tilted cosine of a direction that sees no shadow.
  double lone(const Slant& s) const { return chi_ * (s.cosine + s.sine * tan_ * s.e2 / (2.0 - s.e1)); }

  double tan_, chi_, m0_, m_, shadowing_;
};

double hapke(const Reflectance& r, double m0, double m, double phase) {
  const double surge = r.b0 / (1.0 + portable::tan(0.5 * std::min(phase, kPi - 1e-6)) / r.h);
  const double spread = 1.0 + 2.0 * r.g * portable::cos(phase) + r.g * r.g;
  const double scattered = (1.0 - r.g * r.g) / (spread * std::sqrt(spread));
  const double gamma = std::sqrt(1.0 - r.w);
  const auto light_among = [&](double x) { return (1.0 + 2.0 * x) / (1.0 + 2.0 * x * gamma); };
  const auto smooth = [&](double x0, double x) {
    return r.w / 4.0 * x0 / (x0 + x) * ((1.0 + surge) * scattered + light_among(x0) * light_among(x) - 1.0);
  };
  if (r.theta < 1e-3) return smooth(m0, m);
  const RoughGround ground(r.theta * kPi / 180.0, m0, m, phase);
  return smooth(ground.m0(), ground.m()) * ground.shadowing();
}

double rolo(const Reflectance& r, double m0, double m, double phase) {
  const double a = phase * 180.0 / kPi;
  const double f = r.c0 * portable::exp(-r.c1 * a) + r.a0 + a * (r.a1 + a * (r.a2 + a * (r.a3 + a * r.a4)));
  return std::max(0.0, f) * m0 / (m0 + m);
}

struct Number {
  double Reflectance::*value;
  double low, high;
};
using Numbers = std::map<std::string, Number, std::less<>>;

// What a word for a law sets, and the numbers that may follow it.
struct NamedLaw {
  Reflectance::Law law;
  double lunar_share;
  Numbers numbers;
};

const std::map<std::string, NamedLaw, std::less<>>& named_laws() {
  using Law = Reflectance::Law;
  static const std::map<std::string, NamedLaw, std::less<>> laws{
      {"rock", {Law::kLunarLambert, 0.35, {}}},
      {"lambert", {Law::kLunarLambert, 0.0, {}}},
      {"lommel-seeliger", {Law::kLunarLambert, 1.0, {}}},
      {"mcewen", {Law::kLunarLambert, 0.35, {{"L", {&Reflectance::lunar_share, 0.0, 1.0}}}}},
      {"minnaert", {Law::kMinnaert, 0.35, {{"k", {&Reflectance::k, 0.1, 1.0}}}}},
      {"akimov", {Law::kAkimov, 0.35, {}}},
      {"rolo",
       {Law::kRolo,
        0.35,
        {{"C0", {&Reflectance::c0, 0.0, 10.0}},
         {"C1", {&Reflectance::c1, 0.0, 10.0}},
         {"A0", {&Reflectance::a0, 0.0, 10.0}},
         {"A1", {&Reflectance::a1, -1.0, 1.0}},
         {"A2", {&Reflectance::a2, -1.0, 1.0}},
         {"A3", {&Reflectance::a3, -1.0, 1.0}},
         {"A4", {&Reflectance::a4, -1.0, 1.0}}}}},
      {"hapke",
       {Law::kHapke,
        0.35,
        {{"w", {&Reflectance::w, 1e-4, 0.9999}},
         {"g", {&Reflectance::g, -0.95, 0.95}},
         {"b0", {&Reflectance::b0, 0.0, 10.0}},
         {"h", {&Reflectance::h, 1e-4, 2.0}},
         {"theta", {&Reflectance::theta, 0.0, 60.0}}}}}};
  return laws;
}

// Hapke's numbers as they were fitted to a body: Ceres by Schroeder et al. 2018 (in A&A 634, 2020, table 2),
// the nucleus of Tempel 1 by Li et al. 2007, who state no opposition surge.
const std::map<std::string, std::string, std::less<>> kFittedBodies{
    {"ceres", " w .116 g -.11 b0 1.6 h .054 theta 23"}, {"tempel1", " w .039 g -.49 b0 0 theta 16"}};

// "hapke w .116 ..." for "hapke ceres"; numbers that follow the body's name stay behind its own.
std::string with_fitted_numbers(const std::string& words) {
  std::istringstream in(words);
  std::string law, body, rest;
  in >> law >> body;
  const auto fitted = kFittedBodies.find(body);
  if (law != "hapke" || fitted == kFittedBodies.end()) return words;
  std::getline(in, rest);
  return law + fitted->second + rest;
}

}  // namespace

Reflectance parse_reflectance(const std::string& name, const std::string& words) {
  std::istringstream in(with_fitted_numbers(words));
  std::string law;
  in >> law;
  Reflectance made;
  const auto known = named_laws().find(law);
  if (known == named_laws().end()) {
    throw InputError(
        fmt::format("{}: \"{:.40}\" is no law of reflection; write {}", name, law, kReflectanceWords));
  }
  made.law = known->second.law;
  made.lunar_share = known->second.lunar_share;
  const Numbers& numbers = known->second.numbers;
  for (std::string word, text; in >> word;) {
    const auto number = numbers.find(word);
    if (number == numbers.end()) {
      throw InputError(
          fmt::format("{}: \"{:.40}\" is no number of {}; write {}", name, word, law, kReflectanceWords));
    }
    double value = 0.0;
    text.clear();
    in >> text;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const auto& [member, low, high] = number->second;
    if (text.empty() || error != std::errc() || stop != end)
      throw InputError(fmt::format("{}: {} of {} needs a number, as in \"{} {} {:g}\"", name, word, law, law,
                                   word, 0.5 * (low + high)));
    if (!(value >= low && value <= high)) {
      throw InputError(fmt::format("{}: {} of {} must be {:g} to {:g}", name, word, law, low, high));
    }
    made.*member = value;
    text.clear();
  }
  return made;
}

double reflectance_at(const Reflectance& law, double m0, double m, double phase) {
  switch (law.law) {
    case Reflectance::Law::kLunarLambert:
      return law.lunar_share * 2.0 * m0 / (m0 + m) + (1.0 - law.lunar_share) * m0;
    case Reflectance::Law::kMinnaert:
      return minnaert(law.k, m0, m);
    case Reflectance::Law::kAkimov:
      return akimov(m0, m, phase);
    case Reflectance::Law::kRolo:
      return rolo(law, m0, m, phase);
    case Reflectance::Law::kHapke:
      return hapke(law, m0, m, phase);
  }
  return 0.0;
}

float radiance_factor(const Reflectance& law, float m0, float m, float cos_phase) {
  return static_cast<float>(reflectance_at(law, double{std::max(m0, kLeastCosine)},
                                           double{std::max(m, kLeastCosine)}, arc_cosine(double{cos_phase})));
}

float pictured_reflectance(const Reflectance& law, float m0, float m, float cos_phase) {
  if (law.law == Reflectance::Law::kLunarLambert) {
    const auto lunar = static_cast<float>(law.lunar_share);
    return lunar * 2.0f * m0 / (m0 + std::max(m, kLeastCosine)) + (1.0f - lunar) * m0;
  }
  const double phase = arc_cosine(double{cos_phase});
  const double value =
      reflectance_at(law, double{std::max(m0, kLeastCosine)}, double{std::max(m, kLeastCosine)}, phase);
  if (!is_radiance_factor(law)) return static_cast<float>(value);
  const double midway = std::max(portable::cos(0.5 * phase), double{kLeastCosine});
  const double of_midway = reflectance_at(law, midway, midway, phase);
  return of_midway > 0.0 ? static_cast<float>(value / of_midway * midway) : 0.0f;
}

}  // namespace astrolith
