#include "view/open_model.h"

#include "crease/http_source.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

namespace crease {

namespace {

std::string last_part(const std::string& source) {
  const std::string::size_type end = source.find_first_of("?#");
  const std::string path = is_http_url(source) ? source.substr(0, end) : source;
  const std::string name = std::filesystem::path(path).filename().string();
  return name.empty() ? path : name;
}

Result<AsyncSourcePtr> unlimited_source_of(const ModelSource& model) {
  if (model.built) return async_memory_source(*model.built, model.source);
  if (is_http_url(model.source)) return open_async_http(model.source);
  return open_async_file(model.source);
}

Result<OpenedModel> stream(ModelSource model, const ViewerOptions& options,
                           const StreamLimit& limit, Note& note) {
  Result<AsyncSourcePtr> source = source_of(model, limit);
  if (!source.ok()) return source.failure();
  Result<BlockStreamer> streamer = BlockStreamer::open(
      *std::move(source), {.decode_threads = std::max(1, options.decode_threads),
                           .stopped = [&note] { return note.is_stopped(); }});
  if (!streamer.ok()) return streamer.failure();
  if (streamer->mesh().facts().triangle_count == 0) {
    return fail(Error::NoTriangles, model.source + ": no triangles");
  }
  model.bytes = streamer->head().file_bytes;
  return OpenedModel{std::move(model), *std::move(streamer)};
}

Result<std::vector<std::byte>> build(const std::string& path, const ViewerOptions& options,
                                     Note& note) {
  note.say("reading");
  ImportOptions import = options.import;
  import.progress = note.progress();
  Result<Imported> imported = import_mesh(path, import);
  if (!imported.ok()) return imported.failure();
  note.say("building");
  BuildOptions how = options.build;
  how.simplify.progress = note.progress();
  Result<Built> made = build_model(std::move(imported->mesh), how);
  if (!made.ok()) return made.failure();
  return std::move(made->file_bytes);
}

bool is_crease(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".crease") return true;
  const Result<ByteSourcePtr> bytes = open_file_source(path);
  if (!bytes.ok()) return true;  // opening it again says why
  const Result<BlockFile> file = BlockFile::open(*bytes);
  return file.ok() || file.failure().error != Error::NotCrease;
}

class WatchedSource final : public ByteSource {
 public:
  WatchedSource(ByteSourcePtr source, Note& note) : source_(std::move(source)), note_(note) {}

  std::string name() const override { return source_->name(); }
  std::uint64_t size() const override { return source_->size(); }
  void prefetch(std::span<const FileRange> ranges) const override { source_->prefetch(ranges); }
  std::uint64_t bytes_read() const override { return source_->bytes_read(); }

 private:
  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    if (note_.is_stopped()) return fail(Error::Interrupted, "interrupted");
    const double all = std::max(1.0, double(source_->size()));
    note_.say("loading the whole model", std::min(1.0, double(source_->bytes_read()) / all));
    return source_->read(offset, into);
  }

  const ByteSourcePtr source_;
  Note& note_;
};

Result<ByteSourcePtr> bytes_again(const ModelSource& model, Note& note) {
  if (model.built) return memory_source(*model.built, model.source);
  if (!is_http_url(model.source)) return open_file_source(model.source);
  HttpOptions http;
  http.stopped = [&note] { return note.is_stopped(); };
  return open_http_source(model.source, http);
}

}  // namespace

Result<AsyncSourcePtr> source_of(const ModelSource& model, const StreamLimit& limit) {
  Result<AsyncSourcePtr> source = unlimited_source_of(model);
  if (!source.ok() || !limit) return source;
  return limited_source(*std::move(source), limit);
}

Result<BlockFile> open_again(const ModelSource& model, Note& note) {
  Result<ByteSourcePtr> bytes = bytes_again(model, note);
  if (!bytes.ok()) return bytes.failure();
  return BlockFile::open(std::make_shared<const WatchedSource>(*std::move(bytes), note));
}

Result<OpenedModel> open_model(const std::string& source, const ViewerOptions& options,
                               const StreamLimit& limit, Note& note) {
  ModelSource model{.source = source, .name = last_part(source)};
  if (is_http_url(source)) {
    note.say("connecting");
  } else {
    note.say("opening");
    if (!is_crease(source)) {
      Result<std::vector<std::byte>> bytes = build(source, options, note);
      if (!bytes.ok()) return bytes.failure();
      model.built = std::make_shared<const std::vector<std::byte>>(*std::move(bytes));
    }
  }
  return stream(std::move(model), options, limit, note);
}

}  // namespace crease
