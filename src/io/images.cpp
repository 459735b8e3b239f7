#include "io/images.h"

#include "crease/import.h"
#include "io/read_beside.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

namespace crease {

namespace {

template <std::size_t count>
bool starts_with(std::span<const std::byte> bytes, const std::array<unsigned char, count>& with) {
  return bytes.size() >= count &&
         std::equal(with.begin(), with.end(), bytes.begin(),
                    [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

bool names(std::span<const Material> materials, const std::string& image) {
  return std::any_of(materials.begin(), materials.end(),
                     [&](const Material& m) { return m.base_color_texture == image; });
}

void rename(std::span<Material> materials, const std::string& from, const std::string& to) {
  for (Material& m : materials) {
    if (m.base_color_texture == from) m.base_color_texture = to;
  }
}

Result<std::vector<std::byte>> read_image(const std::filesystem::path& folder,
                                          const std::string& name) {
  Result<FileInFolder> file = find_in_folder(folder, name, kMaxImageBytes);
  if (!file.ok()) {
    const Failure& failure = file.failure();
    const bool is_outside = failure.error == Error::BadValue;
    return fail(failure.error, failure.message + (is_outside ? " (--textures DIR)" : ""));
  }
  if (image_type(file->bytes).empty()) {
    return fail(Error::NotSupported, in_quotes(name) + " " + why_no_image(file->bytes));
  }
  return std::move(file->bytes);
}

}  // namespace

std::string why_no_image(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string words = "is neither a PNG nor a JPEG";
  if (text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == "WEBP") {
    words += ", but WebP";
  } else if (text.starts_with("\xabKTX")) {
    words += ", but KTX";
  } else if (text.starts_with("DDS ")) {
    words += ", but DDS";
  }
  return words;
}

std::string_view image_type(std::span<const std::byte> bytes) {
  static constexpr std::array<unsigned char, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  static constexpr std::array<unsigned char, 3> kJpeg{0xff, 0xd8, 0xff};
  if (starts_with(bytes, kPng)) return "image/png";
  if (starts_with(bytes, kJpeg)) return "image/jpeg";
  return {};
}

std::string unused_name(std::span<const ImageFile> images, const std::string& name) {
  std::string free = name.empty() ? "image" : name;
  for (int i = 2; find_image(images, free) != nullptr; ++i) {
    free = (name.empty() ? "image" : name) + " " + std::to_string(i);
  }
  return free;
}

void settle_images(std::span<Material> materials, std::vector<ImageFile>& images) {
  std::vector<ImageFile> kept;
  for (ImageFile& image : images) {
    if (!names(materials, image.name)) continue;
    const auto same = std::ranges::find_if(
        kept, [&](const ImageFile& other) { return *other.bytes == *image.bytes; });
    if (same != kept.end()) {
      rename(materials, image.name, same->name);
    } else {
      kept.push_back(std::move(image));
    }
  }
  images = std::move(kept);
}

void append_images(std::span<const ImageFile> from, std::span<Material> materials_of_from,
                   std::vector<ImageFile>& to) {
  // Old and new names at once, so that a new one is not taken for an old one.
  std::vector<std::string> new_names;
  for (const ImageFile& image : from) {
    const ImageFile* there = find_image(to, image.name);
    const bool is_same = there != nullptr && *there->bytes == *image.bytes;
    new_names.push_back(is_same ? image.name : unused_name(to, image.name));
    if (!is_same) to.push_back({new_names.back(), image.bytes});
  }
  for (Material& m : materials_of_from) {
    const ImageFile* image = find_image(from, m.base_color_texture);
    if (image == nullptr) continue;
    m.base_color_texture = new_names[static_cast<std::size_t>(image - from.data())];
  }
}

std::vector<std::string> find_images(std::span<const std::filesystem::path> folders,
                                     std::span<const Material> materials,
                                     std::vector<ImageFile>& images) {
  std::vector<std::string> notes, missing;
  for (const Material& m : materials) {
    const std::string& name = m.base_color_texture;
    if (name.empty() || find_image(images, name) != nullptr) continue;
    if (std::ranges::find(missing, name) != missing.end()) continue;
    if (images.size() + missing.size() >= kMaxImages) {
      notes.push_back("textures left out: more than " + std::to_string(kMaxImages) + " images");
      break;
    }
    Result<std::vector<std::byte>> bytes = read_image(folders.front(), name);
    for (const std::filesystem::path& folder : folders.subspan(1)) {
      if (bytes.ok()) break;
      Result<std::vector<std::byte>> other = read_image(folder, name);
      if (other.ok()) bytes = std::move(other);
    }
    if (bytes.ok()) {
      images.push_back({name, std::make_shared<const std::vector<std::byte>>(*std::move(bytes))});
    } else {
      missing.push_back(name);
      notes.push_back("texture left out: " + bytes.failure().message);
    }
  }
  return notes;
}

}  // namespace crease
