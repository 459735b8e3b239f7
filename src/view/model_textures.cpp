#include "view/model_textures.h"

#include "crease/http_source.h"
#include "crease/import.h"
#include "stream/waiting_source.h"

#include <filesystem>
#include <memory>
#include <utility>

namespace crease {

namespace {

std::vector<std::string> find_beside(const ModelSource& model, const std::vector<Material>& names,
                                     std::vector<ImageFile>& images) {
  if (model.built || is_http_url(model.source)) return {};  // a build has looked there
  const std::filesystem::path folder = std::filesystem::path(model.source).parent_path();
  return find_images({&folder, 1}, names, images);
}

}  // namespace

Result<ModelTextures> load_textures(const ModelSource& model, const StreamLimit& limit,
                                    const TextureLimits& textures, Note& note) {
  note.say("loading textures");
  Result<AsyncSourcePtr> bytes = source_of(model, limit);
  if (!bytes.ok()) return bytes.failure();
  const auto source = std::make_shared<const WaitingSource>(*std::move(bytes),
                                                            [&note] { return note.is_stopped(); });
  if (const Status begun = source->begin(); !begun.ok()) return begun.failure();
  const Result<BlockFile> file = BlockFile::open(source);
  if (!file.ok()) return file.failure();
  Result<std::vector<Material>> materials = file->read_materials();
  if (!materials.ok()) return materials.failure();
  const Result<std::vector<ImageEntry>> entries = file->read_image_list();
  if (!entries.ok()) return entries.failure();
  std::vector<ImageFile> images;
  for (const ImageEntry& entry : *entries) {
    note.say("loading textures", double(images.size()) / double(entries->size()));
    Result<std::vector<std::byte>> image = file->read_image(entry);
    if (!image.ok()) return image.failure();
    images.push_back(
        {entry.name, std::make_shared<const std::vector<std::byte>>(*std::move(image))});
  }
  std::vector<std::string> missing = find_beside(model, *materials, images);
  ModelTextures loaded;
  loaded.textures =
      decode_textures(*materials, images, textures, [&note] { return note.is_stopped(); });
  if (note.is_stopped()) return fail(Error::Interrupted, "interrupted");
  std::vector<std::string>& notes = loaded.textures.notes;
  notes.insert(notes.end(), missing.begin(), missing.end());
  loaded.materials = *std::move(materials);
  loaded.bytes_read = source->bytes_read();
  return loaded;
}

}  // namespace crease
