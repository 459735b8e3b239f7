#include "view/model_textures.h"

#include "crease/http_source.h"
#include "crease/import.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

namespace crease {

namespace {

// Waits for an asynchronous source, as a limit lies over none but those.
class PatientSource final : public ByteSource {
 public:
  PatientSource(AsyncSourcePtr source, std::uint64_t size, Note& note)
      : source_(std::move(source)), size_(size), note_(note) {}

  std::string name() const override { return source_->name(); }
  std::uint64_t size() const override { return size_; }
  std::uint64_t bytes_read() const override { return source_->statistics().bytes_transferred; }

 private:
  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    const Ticket ticket = source_->request({offset, into.size()});
    while (!note_.is_stopped()) {
      source_->wait(std::chrono::milliseconds(50));
      for (AsyncAnswer& answer : source_->poll()) {
        if (answer.ticket != ticket) continue;
        if (!answer.bytes.ok()) return answer.bytes.failure();
        std::copy(answer.bytes->begin(), answer.bytes->end(), into.begin());
        return Done{};
      }
    }
    source_->cancel(ticket);
    return fail(Error::Interrupted, "interrupted");
  }

  const AsyncSourcePtr source_;
  const std::uint64_t size_;
  Note& note_;
};

std::vector<std::string> find_beside(const ModelSource& model, const std::vector<Material>& names,
                                     std::vector<ImageFile>& images) {
  if (model.built || is_http_url(model.source)) return {};  // a build has looked there
  return find_images(std::filesystem::path(model.source).parent_path(), names, images);
}

}  // namespace

Result<ModelTextures> load_textures(const ModelSource& model, const StreamLimit& limit,
                                    const TextureLimits& textures, Note& note) {
  note.say("loading textures");
  Result<AsyncSourcePtr> bytes = source_of(model, limit);
  if (!bytes.ok()) return bytes.failure();
  const auto source = std::make_shared<const PatientSource>(*std::move(bytes), model.bytes, note);
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
