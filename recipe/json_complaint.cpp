#include "recipe/json_document_internal.h"

#include <fmt/format.h>

#include <algorithm>

#include "recipe/place_internal.h"

namespace astrolith {
namespace {

struct Complaint {
  std::string_view sign;         // part of the library's message
  std::string_view explanation;  // {} is the word at which the library stopped
};

// The first complaint whose sign stands in the library's message explains it.
constexpr Complaint kComplaints[] = {
    {"unexpected end of input", "the text ends in the middle of a value; is the file cut off?"},
    {"missing closing quote", "the text {} has no closing quote; add it"},
    {"control character", "a text holds a line break or a tab; write \\n or \\t, or close its quote"},
    {"ill-formed UTF-8", "a text is not UTF-8; save the file as UTF-8"},
    {"invalid BOM", "the file begins with bytes that no text begins with; save it as UTF-8"},
    {"forbidden character after backslash",
     "{} has a backslash that means nothing; write \\\\ for a backslash"},
    {"'\\u' must be followed", "{} has \\u without four hexadecimal digits; add them"},
    {"surrogate", "{} has \\u codes that are half of a character; write the character itself"},
    {"number overflow", "the number {} is too large; write a smaller one"},
    {"invalid number", "{} is no number; write it like -0.5 or 2e-3"},
    {"invalid comment", "a comment begins and is none; JSON has no comments, remove it"},
    {"expected end of input", "{} stands behind the end of the recipe; remove it"},
    {"parsing object key", "{} stands where a field's name should, in quotes; is there a comma too many?"},
    {"invalid literal", "{} is no value; write a number, true, false or a text in quotes"},
    {"parsing object separator", "{} stands where the colon after a field's name should; add it"},
    {"parsing object", "{} stands where a comma or a closing brace should; add it"},
    {"parsing array", "{} stands where a comma or a closing bracket should; add it"},
};

// The word or the mark at `position`, which counts from 1.
std::string_view word_at(std::string_view text, std::size_t position) {
  constexpr std::string_view kEnds = " \t\r\n,:[]{}";
  const std::size_t at = std::min(position, text.size());
  if (at == 0) return {};
  if (kEnds.find(text[at - 1]) != std::string_view::npos) return text.substr(at - 1, 1);
  const std::size_t before = text.substr(0, at).find_last_of(kEnds);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  return text.substr(begin, text.find_first_of(kEnds, begin) - begin);
}

}  // namespace

std::string explain_json_problem(std::string_view problem, std::string_view text, std::size_t position) {
  const std::string word = quote_text(word_at(text, position));
  for (const Complaint& complaint : kComplaints) {
    if (problem.find(complaint.sign) != std::string_view::npos) {
      return fmt::format(fmt::runtime(complaint.explanation), word);
    }
  }
  return fmt::format("{} stands where a value should; write one, or remove a comma", word);
}

}  // namespace astrolith
