// JSON without exceptions: a parser that says where, and getters that take whatever is there.
//
//   Result<Json> json = parse_json(source, source.text(), 0);
//   for (std::size_t i = 0; i < size_of(at(*json, "nodes")); ++i) {
//     const Json& node = at(at(*json, "nodes"), i);
//     if (const auto mesh = as_index(at(node, "mesh"))) ...
//   }
//
// Members that are absent, or of another type than asked for, read as null: files are not to be
// trusted, and what must be there is checked where it is used.
#pragma once

#include "crease/result.h"
#include "crease/vec.h"
#include "io/formats.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace crease {

using Json = nlohmann::json;

// `offset` is where `text` begins in the source, for the message.
Result<Json> parse_json(const Source& source, std::string_view text, std::size_t offset);

// The member or element, or a null value.
const Json& at(const Json& object, const char* key);
const Json& at(const Json& array, std::size_t index);
std::size_t size_of(const Json& array);  // 0 if it is not an array

std::optional<std::size_t> as_index(const Json& value);  // a whole number >= 0
double as_number(const Json& value, double otherwise);
std::string as_text(const Json& value);  // empty if it is not a string
bool as_bool(const Json& value);
std::optional<Vec3d> as_vector(const Json& value);  // three numbers

// "NAME: nodes[3].mesh: reason".
Failure fail_at_place(Error error, const Source& source, const std::string& place,
                      const std::string& reason);

// "nodes" and 3 make "nodes[3]".
std::string place_of(std::string_view parent, std::size_t index);

}  // namespace crease
