// The craters and boulders that were found on a mesh: as a table, as figures and as a picture.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "descriptor/features/found_features.h"
#include "synthesis/picture/preview.h"
#include "tasks/description/comparison.h"

namespace astrolith {

// Finds the features of the mesh of a file; error messages begin with its name.
FoundFeatures find_features(const NamedMesh& shape, const FeatureOptions& options, const Progress& progress);

// The numbers of a feature, by the names of their columns.
std::vector<std::pair<const char*, double>> feature_columns(const FoundFeature& feature);

// A .json file holds {"length_unit", "features": [objects]}. Any other file is CSV with a header. Columns
// that the feature lists of synth have too mean the same (synthesis/field/feature_list.h); lengths are in the
// mesh's unit. `unit` may be empty.
void write_found_features(const FoundFeatures& found, const std::string& unit,
                          const std::filesystem::path& file);

// The figures of craters, or of boulders, for the summary: counts, cumulative sizes with their deviation,
// depth over diameter. A feature counts by its confidence c: a number is the sum of c, its deviation the root
// of the sum of c (1 - c).
nlohmann::ordered_json found_json(const FoundFeatures& found, BlobSign sign = BlobSign::hollow);

// Adds the outlines of those whose confidence is at least .5, the `most` surest of them.
void add_rings(const FoundFeatures& found, std::size_t most, PictureMarks& marks);

}  // namespace astrolith
