// The page of a fit's report: photo and texture as reliefs to turn, the verdict, and the figures of the fit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimation/gabor/model_choice.h"
#include "estimation/gabor/photo_fit.h"
#include "estimation/gabor/texture_report.h"
#include "estimation/page/report_page.h"

namespace astrolith {

// The scores of all models, the one that was taken first.
PageTable choice_table(const ModelChoice& choice);
PageTable gaussianity_table(const Gaussianity& gaussianity);
PageTable lobe_table(const FittedChannel& channel);

// Writes index.html into a folder in which write_texture_report has written its figure; the page needs no
// other file. `layer` says what the texture is made of: "lobes", "phase", "exemplar". A relief is as high as
// the picture is bright. Throws InputError where a file cannot be read or written.
void write_texture_page(const TextureReport& report, const std::string& layer, const std::string& verdict,
                        std::vector<PageTable> tables, const std::filesystem::path& folder);

}  // namespace astrolith
