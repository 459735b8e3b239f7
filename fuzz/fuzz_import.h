// Any bytes are a Failure with a message, or a mesh that holds its promises, can be written, and
// reads back with as many triangles. All normal policies take their turn.
#pragma once

#include "crease/export.h"
#include "crease/import.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

namespace crease {

inline void import_and_export(std::span<const std::uint8_t> data, const char* name,
                              const char* extension) {
  ImportOptions options;
  const std::uint8_t choice = data.empty() ? std::uint8_t(0) : data.back();
  options.normals.kind = static_cast<NormalPolicy::Kind>(choice % 4);
  options.same_normal_deg = choice / 4 % 2 == 0 ? 0 : 5;
  const Result<Imported> in = import_bytes(std::as_bytes(data), name, options);
  if (!in.ok()) {
    if (!in.failure().message.starts_with(name)) std::abort();
    return;
  }
  if (!check_mesh(in->mesh).ok() || in->mesh.normals() != &in->mesh.layers[0]) std::abort();
  const auto written = export_bytes(in->mesh, extension);
  if (!written.ok()) std::abort();
  const Result<Imported> back = import_bytes(*written, std::string("back") + extension, {});
  // STL holds floats, in which a triangle may lose its corners, or a corner its finite place.
  if (std::string(extension) == ".stl") return;
  if (!back.ok() || back->mesh.triangle_count() != in->mesh.triangle_count()) std::abort();
}

}  // namespace crease
