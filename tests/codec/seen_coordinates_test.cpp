// Coordinates that others have are told in few bits, whatever else in as many as without asking.
#include "codec/seen_coordinates.h"
#include "codec/range_decoder.h"
#include "codec/range_encoder.h"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace crease::codec {
namespace {

using Place = std::array<std::int32_t, 3>;

struct Asked {
  Place place;
  std::vector<Place> around;
};

// Places about 1000 from the parent's; a coordinate is as often one of those around as told.
std::vector<Asked> some_places(double share, std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<float> far(0, 1000);
  std::uniform_real_distribution<double> choice(0, 1);
  const auto any = [&] { return static_cast<std::int32_t>(far(random)); };
  std::vector<Asked> result(count);
  for (Asked& asked : result) {
    asked.around.resize(random() % 20 == 0 ? 23 : 3);  // now and then more than count
    for (Place& p : asked.around) p = {any(), any(), any()};
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_seen = choice(random) < share;
      asked.place[i] = is_seen ? asked.around[random() % 3][i] : any();
    }
  }
  return result;
}

AxisMixture expected() {
  AxisMixture mixture;
  mixture.weight = {0.9f, 0.1f};
  mixture.center = {0, 200};
  mixture.inverse_scale = {1.0f / 700, 1.0f / 300, 1, 1, 1, 1, 1, 1};
  return mixture;
}

template <class Coder>
std::vector<Place> code(Coder& coder, const std::vector<Asked>& places, bool asks) {
  SeenModels models;
  SeenGate gate;
  std::vector<Place> result;
  for (const Asked& asked : places) {
    SeenPlace seen(models, gate, 0);
    if (seen.looks() && asks) {
      for (const Place& p : asked.around) seen.add(p);
    }
    Place place{};
    for (std::size_t i = 0; i < 3; ++i) {
      AxisMixture mixture = expected();
      const std::int32_t less = i == 2 ? place[0] / 3 : 0;  // as a tangent plane rises
      place[i] = less + seen.code(coder, i, less, mixture, 0, asked.place[i] - less,
                                  [&](std::int32_t value) {
                                    return code_axis(coder, mixture, 0, 700, value);
                                  });
    }
    seen.finish();
    result.push_back(place);
  }
  return result;
}

// How many bytes it takes; it comes back as it was.
std::size_t bytes_of(const std::vector<Asked>& places, bool asks) {
  RangeEncoder encoder;
  code(encoder, places, asks);
  const std::vector<std::byte> bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  const std::vector<Place> decoded = code(decoder, places, asks);
  for (std::size_t i = 0; i < places.size(); ++i) REQUIRE(decoded[i] == places[i].place);
  return bytes.size();
}

TEST_CASE("coordinates of vertices around take few bits, others no more than without them") {
  for (const auto& [seen, at_most] :
       {std::pair(0.95, 0.45), std::pair(0.5, 0.85), std::pair(0.0, 1.005)}) {
    const double share = seen;
    CAPTURE(share);
    const std::vector<Asked> places = some_places(share, 4000);
    const auto with = static_cast<double>(bytes_of(places, true));
    const auto without = static_cast<double>(bytes_of(places, false));
    CAPTURE(with / without);
    CHECK(with < at_most * without);
  }
}

}  // namespace
}  // namespace crease::codec
