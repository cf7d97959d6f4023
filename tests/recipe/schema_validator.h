// Validation of documents by a JSON Schema, with the library valijson.
#pragma once

#include <memory>
#include <string>

namespace astrolith::testing {

class SchemaValidator {
 public:
  // Reads the schema (draft 7) in a file.
  explicit SchemaValidator(const std::string& file);
  ~SchemaValidator();

  // True if the schema accepts a JSON text.
  bool accepts(const std::string& text) const;

 private:
  struct Schema;
  std::unique_ptr<Schema> schema_;
};

}  // namespace astrolith::testing
