// Two thirds of the time that valijson takes to compile is spent on optimising its templates. This file holds
// all of them, and CMakeLists.txt compiles it without optimisation.
#include "tests/recipe/schema_validator.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace astrolith::testing {

using valijson::adapters::NlohmannJsonAdapter;

struct SchemaValidator::Schema {
  valijson::Schema rules;
};

SchemaValidator::SchemaValidator(const std::string& file) : schema_(std::make_unique<Schema>()) {
  const nlohmann::json document = nlohmann::json::parse(std::ifstream(file));
  valijson::SchemaParser(valijson::SchemaParser::kDraft7)
      .populateSchema(NlohmannJsonAdapter(document), schema_->rules);
}

SchemaValidator::~SchemaValidator() = default;

bool SchemaValidator::accepts(const std::string& text) const {
  const nlohmann::json document = nlohmann::json::parse(text);
  return valijson::Validator().validate(schema_->rules, NlohmannJsonAdapter(document), nullptr);
}

}  // namespace astrolith::testing
