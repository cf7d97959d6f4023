#include "synthesis/picture/camera.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string_view>

#include "numerics/errors.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::string_view kCameraWords =
    "lat, lon, from X Y Z, at X Y Z, fov, distance, radii, target X Y Z, up X Y Z, roll";

// The numbers of each word of a camera.
class CameraWords {
 public:
  CameraWords(const std::string& name, const std::string& words) : name_(name) {
    std::istringstream in(words);
    for (std::string word; in >> word;) read(word, in);
  }

  bool has(const std::string& word) const { return found_.contains(word); }
  double number(const std::string& word, double otherwise) const {
    const auto at = found_.find(word);
    return at == found_.end() ? otherwise : at->second[0];
  }
  Vec3d vector(const std::string& word) const {
    const auto& v = found_.at(word);
    return {v[0], v[1], v[2]};
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

 private:
  void read(const std::string& word, std::istringstream& in) {
    static const std::map<std::string, std::size_t, std::less<>> kCounts{
        {"lat", 1},      {"lon", 1},   {"from", 3},   {"at", 3}, {"fov", 1},
        {"distance", 1}, {"radii", 1}, {"target", 3}, {"up", 3}, {"roll", 1}};
    const auto known = kCounts.find(word);
    if (known == kCounts.end()) {
      fail(fmt::format("\"{:.40}\" is no word of a camera; write {}", word, kCameraWords));
    }
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < known->second; ++k) values[k] = next_number(word, in);
    if (!found_.emplace(word, values).second) fail(word + ": is given twice; leave one out");
  }

  double next_number(const std::string& word, std::istringstream& in) const {
    std::string text;
    in >> text;
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc() || rest != end || !(std::fabs(value) <= 1e18)) {
      fail(word + ": \"" + text.substr(0, 40) + "\" is no number; write such as \"lat 20 lon 45 fov 30\"");
    }
    return value;
  }

  std::string name_;
  std::map<std::string, std::array<double, 3>, std::less<>> found_;
};

Vec3d direction_over(double latitude, double longitude) {
  const double c = portable::cos(latitude * kDegree);
  return {c * portable::cos(longitude * kDegree), c * portable::sin(longitude * kDegree),
          portable::sin(latitude * kDegree)};
}

bool has_direction(const Vec3d& v) { return squared_norm(v) > 1e-30; }

// The direction from the target to the camera, and the distance that the words give.
void place(const CameraWords& words, Camera& camera) {
  const bool over = words.has("lat") || words.has("lon");
  if (int(over) + int(words.has("from")) + int(words.has("at")) > 1) {
    words.fail("lat and lon, from, and at say the same in three ways; keep one");
  }
  if (words.has("at")) {
    if (words.has("distance") || words.has("radii")) words.fail("at: is a place; leave out the distance");
    if (!words.has("fov")) words.fail("at: is the place of a pinhole; add fov DEGREES");
    if (!camera.target) camera.target = Vec3d{0, 0, 0};
    camera.from = words.vector("at") - *camera.target;
    camera.distance = norm(camera.from);
  } else if (words.has("from")) {
    camera.from = words.vector("from");
  } else if (over) {
    const double latitude = words.number("lat", 0.0);
    if (!(std::fabs(latitude) <= 90.0)) words.fail("lat: must be -90 to 90 degrees");
    camera.from = direction_over(latitude, words.number("lon", 0.0));
  }
  if (!has_direction(camera.from)) words.fail("the camera stands on its target; move one of them");
}

}  // namespace

Camera view_from(const Vec3d& direction) {
  const Vec3d from = normalized(direction);
  const bool polar = from.x * from.x + from.y * from.y < 1e-6;
  return {from, polar ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}};
}

std::vector<Camera> map_views(MapProjection projection) {
  std::vector<Camera> views;
  for (const double from : {1.0, -1.0}) {
    Camera camera = view_from({from, 0, 0});
    camera.map = projection;
    views.push_back(camera);
  }
  if (projection == MapProjection::kEquirectangular) views.pop_back();
  return views;
}

std::vector<Camera> standard_views() {
  return {
      {{1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}}, {{1.0, -1.2, 0.8}, {0, 0, 1}}};
}

std::vector<Camera> usual_views(const TriangleMesh& mesh) {
  // The areas of a closed surface, as vectors, add up to nothing; those of a plane to its whole area.
  constexpr double kFacesOneWay = 0.5;
  Vec3d facing{0, 0, 0};
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& p = mesh.vertices[t[0]];
    const Vec3d twice = cross(mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p);
    facing += twice;
    area += norm(twice);
  }
  if (!(norm(facing) > kFacesOneWay * area)) return standard_views();
  const Camera above = view_from(facing);
  const Vec3d north = normalized(above.up - dot(above.up, above.from) * above.from);
  return {above, {above.from - 1.2 * north, above.from}};
}

Camera parse_camera(const std::string& name, const std::string& text) {
  const CameraWords words(name, text);
  Camera camera;
  if (words.has("target")) camera.target = words.vector("target");
  place(words, camera);
  camera.up = words.has("up") ? words.vector("up") : view_from(camera.from).up;
  if (!has_direction(cross(normalized(camera.up), normalized(camera.from)))) {
    words.fail("up: lies along the line of sight; choose another up");
  }
  camera.roll = words.number("roll", 0.0);
  camera.field_of_view = words.number("fov", 0.0);
  if (words.has("fov") && !(camera.field_of_view >= 1e-4 && camera.field_of_view < 175.0)) {
    words.fail("fov: must be .0001 to 175 degrees");
  }
  if (words.has("at")) return camera;
  if (words.has("distance") && words.has("radii")) words.fail("distance and radii say the same; keep one");
  camera.in_radii = words.has("radii");
  if (!camera.in_radii && !words.has("distance")) return camera;
  camera.distance = words.number(camera.in_radii ? "radii" : "distance", 0.0);
  if (!(camera.distance > 0.0)) words.fail("the distance must be above 0");
  if (!words.has("fov")) words.fail("a distance needs a field of view; add fov DEGREES");
  return camera;
}

}  // namespace astrolith
