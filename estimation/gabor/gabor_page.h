// The page of a fit's report: photo and noise as reliefs to turn, the verdict, and the figures of the fit.
#pragma once

#include <filesystem>
#include <string>

#include "estimation/gabor/gabor_report.h"
#include "estimation/gabor/photo_fit.h"

namespace astrolith {

// Writes index.html into a folder in which write_gabor_report has written its figure; the page needs no other
// file. A relief is as high as the picture is bright. Throws InputError where a file cannot be read or
// written.
void write_gabor_page(const ReportPicture& exemplar, const ReportPicture& synthesis,
                      const FittedChannel& channel, const std::string& title,
                      const std::filesystem::path& folder);

}  // namespace astrolith
