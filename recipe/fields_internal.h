// The lists of fields of a recipe's structs, but for kinds of layers, whose lists are declared beside their
// structs. One list of a struct's fields serves the reader, the writer and the check of a recipe:
//
//   void visit_fields(FieldVisitor& v, Locality& locality) {
//     v.required("group", locality.group);
//     v.required("width", locality.width, kPositive);
//   }
//
// The writer writes the fields in the list's order. A FieldVisitor decides what happens to each field. Each
// list stands beside the rules for its struct, in one file a part of the recipe: body_fields.cpp,
// noise_layer_fields.cpp, landform_fields.cpp, layer_use_fields.cpp and recipe_fields.cpp.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "recipe/body.h"
#include "recipe/place_internal.h"
#include "recipe/recipe.h"

namespace astrolith {

// Limits of a number in a list of fields.
struct NumberLimits {
  double low, high;
  std::string_view words;  // the limits in a message, where {0} is `low` and {1} is `high`
  bool low_is_allowed = true;
};
struct IntegerLimits {
  int low, high;
};

constexpr NumberLimits range(double low, double high) { return {low, high, "from {0:g} to {1:g}"}; }
constexpr IntegerLimits range(int low, int high) { return {low, high}; }
constexpr NumberLimits above_one(double high) { return {1.0, high, "above {0:g} and at most {1:g}", false}; }
inline constexpr NumberLimits kAnyNumber = range(-kMaxNumber, kMaxNumber);
inline constexpr NumberLimits kNotNegative = range(0.0, kMaxNumber);
inline constexpr NumberLimits kPositive = {kMinPositive, kMaxNumber, "above 0 (from {0:g} to {1:g})"};
inline constexpr NumberLimits kShare = range(0.0, 1.0);

// Both functions throw InputError at `place` for a value outside the limits. NaN lies outside.
void expect(double value, const NumberLimits& limits, const Place& place);
void expect(int value, const IntegerLimits& limits, const Place& place);

// A number in a row such as [x, y, z, radius].
template <class T, class Limits>
struct Column {
  std::string_view name;
  T& number;
  Limits limits;
};
template <class T, class Limits>
Column(std::string_view, T&, Limits) -> Column<T, Limits>;

// Members of a JSON object that may have any names, sorted by name.
template <class T, class Value>
struct NamedMembers {
  std::vector<T>& members;
  std::string T::*name;
  Value T::*value;
};
template <class T, class Value>
NamedMembers(std::vector<T>&, std::string T::*, Value T::*) -> NamedMembers<T, Value>;

class FieldVisitor {
 public:
  enum class Task { kRead, kWrite, kCheck, kDescribe };

  // `root` must outlive the visitor.
  FieldVisitor(Task task, const Place& root) : task_(task), place_(&root) {}
  virtual ~FieldVisitor() = default;

  // Visits all fields of a struct.
  template <class T>
  void visit(T& object) {
    value(object);
  }
  // The lists of fields change a struct only for a reader, so that other visitors may visit a constant one.
  template <class T>
  void inspect(const T& object) {
    value(const_cast<T&>(object));
  }

  bool reading() const { return task_ == Task::kRead; }
  bool checking() const { return task_ == Task::kCheck; }
  // The path of the object or value that is being visited.
  const Place& place() const { return *place_; }

  // A field that keeps its default when the file lacks it. The field is always written, except for an empty
  // std::optional.
  template <class T, class... Limits>
  void field(std::string_view name, T&& value, const Limits&... limits) {
    visit_field(name, false, is_stated(value), value, limits...);
  }
  // A field that the file must have.
  template <class T, class... Limits>
  void required(std::string_view name, T&& value, const Limits&... limits) {
    visit_field(name, true, is_stated(value), value, limits...);
  }
  // A field that is written and checked only on a condition.
  template <class T, class... Limits>
  void field_if(bool written, std::string_view name, T&& value, const Limits&... limits) {
    visit_field(name, false, written, value, limits...);
  }
  // A field that holds one of several words. `to_word` gives the word for a value.
  template <class T, std::size_t n>
  void word(std::string_view name, T& value, const T (&values)[n], std::string_view (*to_word)(T)) {
    std::string text(to_word(value));
    field(name, text);
    choose(name, value, values, to_word, text);
  }
  template <class T, std::size_t n>
  void required_word(std::string_view name, T& value, const T (&values)[n], std::string_view (*to_word)(T)) {
    std::string text(reading() ? std::string_view() : to_word(value));
    required(name, text);
    choose(name, value, values, to_word, text);
  }
  // A field of older recipes. A reader takes the one word that changes nothing, and fails with `message` on
  // any other; other visitors do not see the field.
  void retired(std::string_view name, std::string_view harmless, std::string_view message) {
    if (!reading()) return;
    std::string word(harmless);
    field(name, word);
    if (word != harmless) place_->field(name).fail(quote_text(word) + " " + std::string(message));
  }
  // Makes the current value an array of numbers, written on one line.
  template <class... T, class... Limits>
  void row(const Column<T, Limits>&... columns) {
    const std::string_view names[] = {columns.name...};
    begin_array(sizeof...(columns), names, true);
    std::size_t index = 0;
    (visit_element(index++, place_->field(columns.name), columns.number, columns.limits), ...);
    end_array();
  }
  // Makes the current value an array of a fixed number of elements. Messages call an element `noun`.
  template <class T, class... Limits>
  void array(std::string_view noun, std::initializer_list<T*> elements, const Limits&... limits) {
    begin_array(elements.size(), std::vector(elements.size(), noun), false);
    std::size_t index = 0;
    for (T* element : elements) {
      visit_element(index, place_->element(index), *element, limits...);
      ++index;
    }
    end_array();
  }
  // A rule that concerns several fields. `check` throws InputError where the recipe breaks the rule.
  template <class T>
  void rule(void (*check)(const T&, const Place&), const std::type_identity_t<T>& subject) {
    if (checking()) check(subject, *place_);
  }

 protected:
  // Each hook reads, writes or checks a value at place(). A visitor overrides the hooks that concern it.
  virtual void visit_number(double&, const NumberLimits&) {}
  virtual void visit_integer(int&, const IntegerLimits&) {}
  virtual void visit_seed(std::uint64_t&) {}
  virtual void visit_flag(bool&) {}
  virtual void visit_text(std::string&) {}

  // Begins a field of the current object. When it returns false, the field is skipped and leave() is not
  // called.
  virtual bool enter(std::string_view, bool /*required*/, bool written) { return written; }
  virtual void enter_element(std::size_t) {}
  virtual void leave() {}
  virtual void begin_object() {}
  virtual void end_object() {}
  // An object that may have members of any names. A reader returns the names in the file, in order.
  virtual std::vector<std::string> begin_members() { return {}; }
  virtual void end_members() {}
  // Returns the number of elements to visit. If there are `names`, the array must have an element for each.
  virtual std::size_t begin_array(std::size_t size, std::span<const std::string_view> /*names*/,
                                  bool /*one_line*/) {
    return size;
  }
  virtual void end_array() {}

 private:
  template <class T>
  static bool is_stated(const T&) {
    return true;
  }
  template <class T>
  static bool is_stated(const std::optional<T>& value) {
    return value.has_value();
  }

  void value(double& number, const NumberLimits& limits) { visit_number(number, limits); }
  void value(int& number, const IntegerLimits& limits) { visit_integer(number, limits); }
  void value(std::uint64_t& seed) { visit_seed(seed); }
  void value(bool& flag) { visit_flag(flag); }
  void value(std::string& text) { visit_text(text); }
  template <class T, class... Limits>
  void value(std::optional<T>& optional, const Limits&... limits) {
    value(optional ? *optional : optional.emplace(), limits...);
  }
  template <class T, class... Limits>
  void value(std::vector<T>& list, const Limits&... limits) {
    const std::size_t size = begin_array(list.size(), {}, std::is_same_v<T, int>);
    if (reading()) list.resize(size);
    for (std::size_t i = 0; i < size; ++i) visit_element(i, place_->element(i), list[i], limits...);
    end_array();
  }
  template <class T, class Value, class... Limits>
  void value(NamedMembers<T, Value>& object, const Limits&... limits) {
    for (std::string& name : begin_members()) object.members.emplace_back().*object.name = std::move(name);
    const std::string* last = nullptr;
    for (T& member : object.members) {
      const std::string& name = member.*object.name;
      if (last != nullptr && !(*last < name)) {
        place_->fail("must be sorted by name, each name once: " + quote_text(name) + " is not");
      }
      last = &name;
      visit_field(name, false, true, member.*object.value, limits...);
    }
    end_members();
  }
  // A struct is a row where it has a visit_row, else an object.
  template <class T, class... Limits>
  void value(T& object, const Limits&... limits) {
    if constexpr (requires { visit_row(*this, object, limits...); }) {
      visit_row(*this, object, limits...);
    } else {
      begin_object();
      visit_fields(*this, object);
      end_object();
    }
  }

  template <class T, class... Limits>
  void visit_field(std::string_view name, bool required, bool written, T& member, const Limits&... limits) {
    if (enter(name, required, written)) visit_inside(place_->field(name), member, limits...);
  }
  template <class T, class... Limits>
  void visit_element(std::size_t index, const Place& place, T& element, const Limits&... limits) {
    enter_element(index);
    visit_inside(place, element, limits...);
  }
  template <class T, class... Limits>
  void visit_inside(const Place& place, T& member, const Limits&... limits) {
    const Place* const outer = std::exchange(place_, &place);
    value(member, limits...);
    place_ = outer;
    leave();
  }

  template <class T, std::size_t n>
  void choose(std::string_view name, T& value, const T (&values)[n], std::string_view (*to_word)(T),
              std::string_view text) {
    if (!reading()) return;
    std::vector<std::string_view> words;
    for (const T candidate : values) {
      if (text == words.emplace_back(to_word(candidate))) {
        value = candidate;
        return;
      }
    }
    place_->field(name).fail("must be " + quote_list(words, " or ") + ", is " + quote_text(text));
  }

  const Task task_;
  const Place* place_;
};

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
void visit_fields(FieldVisitor& v, AlbedoByElevation& by);
void visit_fields(FieldVisitor& v, GroundAlbedo& albedo);
void visit_fields(FieldVisitor& v, LayerAlbedo& albedo);
void visit_fields(FieldVisitor& v, CraterAlbedo& albedo);
void visit_fields(FieldVisitor& v, BoulderAlbedo& albedo);
// The rules for albedos that concern the rest of the recipe.
void check_albedos(const Recipe& recipe, const Place& place);
// The rules for a layer that concern other layers or the body.
void check_layer_uses(const Recipe& recipe, const Place& place);

}  // namespace astrolith
