#include "io/json.h"

#include <cmath>

namespace crease {
namespace {

const Json kNull;

// Finds the place of the first error; nlohmann's parser without exceptions keeps it to itself.
struct ErrorFinder : nlohmann::json_sax<Json> {
  std::size_t position = 0;
  bool out_of_range = false;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t where, const std::string&,
                   const nlohmann::detail::exception& error) override {
    position = where == 0 ? 0 : where - 1;
    out_of_range = error.id == 406;  // a number too large for a double
    return false;
  }
};

}  // namespace

Result<Json> parse_json(const Source& source, std::string_view text, std::size_t offset) {
  Json json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!json.is_discarded()) return json;
  ErrorFinder finder;
  Json::sax_parse(text.begin(), text.end(), &finder);
  const bool ends_early = finder.position >= text.size();
  if (ends_early) {
    return fail_at_byte(Error::Truncated, source, offset + text.size(), "JSON ends early");
  }
  return fail_at_byte(Error::BadFormat, source, offset + finder.position,
                      finder.out_of_range ? "number out of range" : "not JSON");
}

const Json& at(const Json& object, const char* key) {
  if (!object.is_object()) return kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

const Json& at(const Json& array, std::size_t index) {
  return index < size_of(array) ? array[index] : kNull;
}

std::size_t size_of(const Json& array) {
  return array.is_array() ? array.size() : 0;
}

std::optional<std::size_t> as_index(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::size_t>();
  if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    if (number >= 0) return static_cast<std::size_t>(number);
  }
  if (value.is_number_float()) {  // some exporters write 3.0
    const double number = value.get<double>();
    if (number >= 0 && number < 9e15 && number == std::floor(number)) {
      return static_cast<std::size_t>(number);
    }
  }
  return std::nullopt;
}

double as_number(const Json& value, double otherwise) {
  return value.is_number() ? value.get<double>() : otherwise;
}

std::string as_text(const Json& value) {
  const auto* text = value.get_ptr<const std::string*>();
  return text == nullptr ? std::string() : *text;
}

bool as_bool(const Json& value) {
  return value.is_boolean() && value.get<bool>();
}

std::optional<Vec3d> as_vector(const Json& value) {
  if (size_of(value) != 3) return std::nullopt;
  Vec3d result;
  for (int k = 0; k < 3; ++k) {
    const Json& number = value[static_cast<std::size_t>(k)];
    if (!number.is_number()) return std::nullopt;
    result[k] = number.get<double>();
  }
  return result;
}

Failure fail_at_place(Error error, const Source& source, const std::string& place,
                      const std::string& reason) {
  return fail(error, source.name + ": " + place + ": " + reason);
}

std::string place_of(std::string_view parent, std::size_t index) {
  return std::string(parent) + "[" + std::to_string(index) + "]";
}

}  // namespace crease
