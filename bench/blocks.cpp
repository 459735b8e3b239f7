// A line per model: bits per input vertex that its blocks take, by stream, in one run.
//
//   bench_blocks [--bits B] [--endpoint] [--geometry] [--encodings N] [--decodings N] MODEL...
//
// --geometry: without attributes and categories, as beside Draco without normals.
#include "crease/import.h"
#include "crease/simplify.h"
#include "pipeline/encode_blocks.h"
#include "pipeline/snap_attributes.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <utility>

namespace crease {
namespace {

struct Options {
  int bits = 14, encodings = 1, decodings = 1;  // of which the fastest count
  bool endpoint = false, geometry = false;
};

double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

int measure(const std::string& path, const Options& options) {
  Result<Imported> in = import_mesh(path, {});
  if (!in.ok()) {
    std::fprintf(stderr, "%s\n", in.failure().message.c_str());
    return 1;
  }
  Mesh mesh = std::move(in->mesh);
  const Grid grid = make_grid(mesh, {.length = 0, .bits = options.bits});
  snap(mesh, grid);
  std::vector<LayerCoding> codings =
      codings_of(mesh, {.normal_bits = 10, .texcoord_bits = 12, .color_bits = 8});
  snap_to_codings(mesh, codings);
  SimplifyOptions simplify_options;
  simplify_options.record_bands = true;
  if (options.endpoint) simplify_options.placement = Placement::Endpoint;
  Result<ContractionSequence> sequence = simplify(mesh, grid, simplify_options);
  snap_new_values(*sequence, mesh, codings);
  if (options.geometry) {
    mesh.layers.clear();
    mesh.material_of_triangle.clear();
    mesh.part_of_triangle.clear();
    for (Contraction& c : sequence->contractions) c.change_count = c.derived_count = 0;
  }
  codings.resize(mesh.layers.size());
  const codec::BlockCoding coding = block_coding(mesh, codings);
  const std::vector<BandPlans> plans = plan_blocks(mesh, *sequence, codings);
  std::vector<CodedBlock> blocks;
  double encoding = 1e9;
  for (int round = 0; round < options.encodings; ++round) {
    std::vector<BandPlans> own = plans;
    const double begin = cpu_seconds();
    Result<std::vector<CodedBlock>> encoded = encode_blocks(std::move(own), coding);
    encoding = std::min(encoding, cpu_seconds() - begin);
    if (!encoded.ok()) {
      std::fprintf(stderr, "%s: %s\n", path.c_str(), encoded.failure().message.c_str());
      return 1;
    }
    blocks = *std::move(encoded);
  }

  // Every stream of every block, decoded again; metered in the last round alone.
  codec::StreamBits bits{};
  std::vector<codec::FineEnd> ends;
  std::size_t bytes = 0, next = 0;
  double decoding = 1e9;
  for (int round = 0; round <= options.decodings; ++round) {
    const bool meter = round == options.decodings;
    double seconds = 0;
    ends.clear();
    next = bytes = 0;
    for (const BandPlans& band : plans) {
      std::vector<codec::CoarseEnd> starts =
          codec::sort_by_label(ends, static_cast<std::uint32_t>(band.plans.size()));
      ends.clear();
      for (codec::CoarseEnd& start : starts) {
        const CodedBlock& block = blocks[next];
        bytes += block.bytes.size();
        const double before = cpu_seconds();
        Result<codec::DecodedBlock> decoded =
            codec::decode_block(block.bytes, static_cast<std::uint32_t>(next), coding,
                                block.limits(), std::move(start), meter ? &bits : nullptr);
        seconds += cpu_seconds() - before;
        if (!decoded.ok()) {
          std::fprintf(stderr, "%s: %s\n", path.c_str(), decoded.failure().message.c_str());
          return 1;
        }
        ends.push_back(std::move(decoded->end));
        ++next;
      }
    }
    if (!meter) decoding = std::min(decoding, seconds);
  }
  const double vertices = double(mesh.vertex_count());
  std::printf(
      "%-28s %8zu vertices %5zu blocks  %6.2f bits:", path.substr(path.rfind('/') + 1).c_str(),
      mesh.vertex_count(), blocks.size(), 8 * double(bytes) / vertices);
  const char* names[] = {"roots", "flags", "shapes", "positions", "categories", "values", "labels"};
  for (std::size_t s = 0; s < bits.size(); ++s) {
    std::printf(" %s %.2f", names[s], bits[s] / vertices);
  }
  const double million = double(mesh.triangle_count()) / 1e6;
  std::printf("; encoded %.2f, decoded %.2f M triangles/s\n", million / encoding,
              million / decoding);
  return 0;
}

}  // namespace
}  // namespace crease

int main(int argc, char** argv) {
  crease::Options options;
  std::vector<std::string> models;
  CLI::App app{"Bits of the blocks of models"};
  app.add_option("--bits", options.bits, "of the grid, over the longest side");
  app.add_option("--encodings", options.encodings, "of which the fastest counts");
  app.add_option("--decodings", options.decodings, "likewise");
  app.add_flag("--endpoint", options.endpoint, "endpoint placement");
  app.add_flag("--geometry", options.geometry, "no attributes, no materials, no parts");
  app.add_option("models", models)->required();
  CLI11_PARSE(app, argc, argv);
  int status = 0;
  for (const std::string& model : models) status |= crease::measure(model, options);
  return status;
}
