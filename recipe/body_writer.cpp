#include "recipe/body_internal.h"

namespace astrolith {

using nlohmann::ordered_json;

ordered_json to_json(const Vec3d& v) { return {v.x, v.y, v.z}; }

ordered_json to_json(const Warp& warp) {
  return {{"amplitude", warp.amplitude},
          {"frequency", warp.frequency},
          {"octaves", warp.octaves},
          {"gain", warp.gain},
          {"lacunarity", warp.lacunarity}};
}

namespace {

ordered_json to_json(const BodyOperation& operation) {
  ordered_json object{{"type", operator_word(operation.kind)}};
  if (operation.kind == Operator::kBlend) {
    object["width"] = operation.width;
    object["exponent"] = operation.exponent;
  } else if (operation.kind == Operator::kCleanUnion) {
    object["bulge"] = operation.bulge;
    object["reach"] = {operation.reach[0], operation.reach[1]};
  } else {
    object["alpha"] = operation.alpha;
  }
  object["body"] = to_json(operation.operand.front());
  return object;
}

ordered_json to_json(const std::vector<Sphere>& spheres) {
  ordered_json rows = ordered_json::array();
  for (const Sphere& s : spheres) {
    rows.push_back(ordered_json::array({s.center.x, s.center.y, s.center.z, s.radius}));
  }
  return rows;
}

}  // namespace

ordered_json to_json(const MetaballBody& body) {
  ordered_json object{{"type", "metaballs"},
                      {"kernel", kernel_word(body.kernel)},
                      {"a", body.a},
                      {"b", body.b},
                      {"blend_exponent", body.blend_exponent},
                      {"iso_value", body.iso_value},
                      {"cutoff_radii", body.cutoff_radii},
                      {"spheres", to_json(body.spheres)}};
  if (!body.subtract.empty()) object["subtract"] = to_json(body.subtract);
  for (const SphereGroup& group : body.groups) object["groups"][group.name] = group.spheres;
  if (body.warp) object["warp"] = to_json(*body.warp);
  for (const BodyOperation& operation : body.operations) object["operations"].push_back(to_json(operation));
  return object;
}

}  // namespace astrolith
