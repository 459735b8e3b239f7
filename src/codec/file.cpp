#include "crease/file.h"

#include <algorithm>
#include <utility>

namespace crease {

Result<BlockFile> open_crease(const std::filesystem::path& path) {
  Result<ByteSourcePtr> source = open_file_source(path);
  if (!source.ok()) return source.failure();
  return BlockFile::open(*std::move(source));
}

namespace {

// What the sequence says of each band beside what the head does.
void check_bands(const BlockFile& file, std::vector<std::string>& wrong) {
  const std::vector<BandFacts>& bands = file.facts().bands;
  std::vector<std::uint64_t> splits(bands.size() + 1, 0), coarse = splits, fine = splits;
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const Result<DirectoryPage> page = file.read_page(p);
    if (!page.ok()) return wrong.push_back(page.failure().message);
    for (const BlockEntry& entry : page->blocks) {
      splits[entry.facts.band] += entry.facts.splits;
      coarse[entry.facts.band] += entry.facts.triangles_coarse;
      fine[entry.facts.band] += entry.facts.triangles_fine;
    }
  }
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (splits[b] != bands[b].contractions || coarse[b] != bands[b].triangles_after ||
        coarse[b] != fine[b + 1]) {
      wrong.push_back("band " + std::to_string(b) + ": its blocks have other counts than the head");
    }
  }
  if (fine[0] != file.facts().triangle_count) {
    wrong.push_back("the finest blocks have not as many triangles as the model");
  }
}

}  // namespace

std::vector<std::string> validate_crease(const BlockFile& file, const DecodeOptions& options) {
  std::vector<std::string> wrong = file.validate();
  if (!wrong.empty()) return wrong;
  const Result<DecodedModel> model = decode_model(file, options);
  if (!model.ok()) return {model.failure().message};
  check_bands(file, wrong);
  if (model->mesh.vertex_count() != file.facts().vertex_count) {
    wrong.push_back("its blocks have not as many vertices as the head says");
  }
  if (Status status = check_contractions(model->mesh, model->sequence); !status.ok()) {
    wrong.push_back("contractions: " + status.failure().message);
  }
  return wrong;
}

}  // namespace crease
