// Bytes as text (RFC 4648, section 4).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace astrolith {

std::string base64_text(std::string_view bytes);

// The bytes of a text that base64_text() makes; none for any other text.
std::optional<std::string> base64_bytes(std::string_view text);

}  // namespace astrolith
