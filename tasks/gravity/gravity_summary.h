// The figures of a whole body, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "gravity/body_mass.h"
#include "tasks/gravity/body_parts.h"
#include "tasks/gravity/gravity_body.h"

namespace astrolith {

// Volume, area, mass, centre of mass, moments and axes. SI units; the centre in metres of the body's frame.
// `mass` is that of the whole with its parts, as multiples of the density; `volume` is in the body's unit.
nlohmann::ordered_json mass_json(const GravityBody& body, const BodyMass& mass, double volume,
                                 double density);

// The file, the density and the mass of each part.
nlohmann::ordered_json parts_json(const GravityBody& body, const std::vector<BodyPart>& parts);

// Coefficients about the centre of mass for the reference radius in the body's unit; 0 stands for the
// distance of the farthest vertex.
nlohmann::ordered_json coefficients_json(const GravityBody& body, const BodyMass& mass,
                                         const std::vector<BodyPart>& parts, double radius, int degree,
                                         const Progress& progress);

}  // namespace astrolith
