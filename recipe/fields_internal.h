// The lists of fields of a recipe's structs, but for kinds of layers, whose lists are declared beside their
// structs. Each list stands beside the rules for its struct, in one file a part of the recipe:
// body_fields.cpp, noise_layer_fields.cpp, landform_fields.cpp, layer_use_fields.cpp and recipe_fields.cpp.
#pragma once

#include "recipe/field_visitor_internal.h"
#include "recipe/recipe.h"

namespace astrolith {

void visit_fields(FieldVisitor& v, Recipe& recipe);
void visit_fields(FieldVisitor& v, Provenance& provenance);
void visit_fields(FieldVisitor& v, Erosion& erosion);

void visit_fields(FieldVisitor& v, Family& family);
void visit_fields(FieldVisitor& v, DrawnField& drawn);
// The rules for a family that concern the rest of the recipe.
void check_family(const Recipe& recipe, const Place& place);

void visit_row(FieldVisitor& v, Vec3d& vector, const NumberLimits& limits);
void visit_fields(FieldVisitor& v, MetaballBody& body);
void visit_fields(FieldVisitor& v, Donor& donor);
// Fails for all but metaballs without operations, groups and warp.
void check_plain_metaballs(const MetaballBody& body, const Place& place);
void visit_fields(FieldVisitor& v, BodyPopulation& population);
void visit_fields(FieldVisitor& v, MeasuredBody& body);
void visit_fields(FieldVisitor& v, DrawConditions& draw);
void visit_fields(FieldVisitor& v, BodyOperation& operation);
void visit_fields(FieldVisitor& v, Warp& warp);
// The fields of a fractal sum that follow its frequency, and the limit on the frequency of its last octave.
void visit_octaves(FieldVisitor& v, double frequency, int& octaves, double& gain, double& lacunarity);

void visit_fields(FieldVisitor& v, Layer& layer);
void visit_fields(FieldVisitor& v, LayerColor& color);
void visit_fields(FieldVisitor& v, SpotPart& part);
void visit_fields(FieldVisitor& v, CraterProfile& profile);
void visit_fields(FieldVisitor& v, Crater& crater);
void visit_fields(FieldVisitor& v, WeibullSizes& sizes);
void visit_fields(FieldVisitor& v, Clusters& clusters);
void visit_fields(FieldVisitor& v, CraterPopulation& population);
void visit_fields(FieldVisitor& v, Boulder& boulder);
void visit_fields(FieldVisitor& v, BoulderPopulation& population);
void visit_fields(FieldVisitor& v, LocalGravity& gravity);

// The fields that every kind of noise layer has beside its own.
void visit_fields(FieldVisitor& v, LayerUse& use);
void visit_fields(FieldVisitor& v, Locality& locality);
void visit_fields(FieldVisitor& v, LayerMask& mask);
void visit_fields(FieldVisitor& v, Combination& combination);
// The rules for a layer that concern other layers or the body.
void check_layer_uses(const Recipe& recipe, const Place& place);

}  // namespace astrolith
