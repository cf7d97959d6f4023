// Text as HTML, bytes as text, and the script of a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace astrolith {

// `text` with &, <, > and " as entities.
std::string escaped_html(const std::string& text);

// RFC 4648, with padding and without line breaks.
std::string base64(std::span<const std::uint8_t> bytes);

// surface_viewer.js and the view that it uses, which the build takes into the program: see
// page_scripts.cpp.in.
const char* surface_viewer_script();

}  // namespace astrolith
