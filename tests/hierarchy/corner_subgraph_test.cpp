#include "hierarchy/corner_subgraph.h"

#include <doctest/doctest.h>

#include <random>
#include <string>

namespace crease {
namespace {

constexpr RelativeAttribute kR = kRemoved;

// "RM/RMC 01": the symbols of v_t and v_u, and the bits.
std::string as_text(const SubgraphCode& code) {
  if (code.is_explicit) return "explicit";
  std::string text;
  for (AttributeSymbol s : code.first) text += "RCMX"[static_cast<int>(s)];
  text += '/';
  for (AttributeSymbol s : code.second) text += "RCMX"[static_cast<int>(s)];
  for (std::size_t i = 0; i < code.second_goes_first.size(); ++i) {
    text += i == 0 ? " " : "";
    text += code.second_goes_first[i] ? '1' : '0';
  }
  return text;
}

// G03 figure 11:    v_t   v_s   v_u
//                    0           0
//                    1-----0-----1
//                          1-----2
TEST_CASE("the subgraph of G03 figure 11 has the streams RM and RMC") {
  const CornerSubgraph graph{{kR, 0}, {kR, 0, 1}};
  const SubgraphCode code = encode_subgraph(graph);
  CHECK(as_text(code) == "RM/RMC");
  CHECK(decode_subgraph(code) == graph);
}

//    0----.
//    1----0-----0
TEST_CASE("of several that become one, the second and later ones of a side are X") {
  CHECK(as_text(encode_subgraph({{0, 0}, {0}})) == "MX/M");
  CHECK(as_text(encode_subgraph({{0, 0, 1}, {1}})) == "CXM/M");  // none of the other side
  CHECK(as_text(encode_subgraph({{0, kR, 0}, {0, 0}})) == "MRX/MX");
}

TEST_CASE("a bit tells which of two copies that face each other comes first") {
  CHECK(as_text(encode_subgraph({{0}, {1}})) == "C/C 0");
  CHECK(as_text(encode_subgraph({{1}, {0}})) == "C/C 1");
  CHECK(as_text(encode_subgraph({{0, 2}, {1}})) == "CC/C 01");
}

//    0--. .--0
//        X          crosses on one side: v_t's second attribute has the first parent
//    1--' '--1
TEST_CASE("a graph with crossing edges is stored as it is, and flagged (G03 figures 9 d and 10)") {
  const CornerSubgraph graph{{1, 0}, {0, 1}};
  CHECK(has_crossing(graph));
  const SubgraphCode code = encode_subgraph(graph);
  CHECK(as_text(code) == "explicit");
  CHECK(decode_subgraph(code) == graph);
}

TEST_CASE("every graph comes back from its symbols") {
  std::mt19937_64 random(7);
  for (int round = 0; round < 20000; ++round) {
    const std::size_t parents = random() % 5;
    CornerSubgraph graph;
    for (auto* side : {&graph.parents_of_first, &graph.parents_of_second}) {
      for (std::size_t p = 0; p < parents; ++p) {
        for (std::size_t n = random() % 3; n > 0; --n) {
          side->push_back(static_cast<RelativeAttribute>(p));
        }
        if (random() % 4 == 0) side->push_back(kR);
      }
    }
    // Parents without children do not exist: close the gaps.
    RelativeAttribute next = 0;
    for (RelativeAttribute p = 0; p < parents; ++p) {
      bool used = false;
      for (auto* side : {&graph.parents_of_first, &graph.parents_of_second}) {
        for (RelativeAttribute& q : *side) {
          if (q != p) continue;
          q = next;
          used = true;
        }
      }
      next = static_cast<RelativeAttribute>(next + (used ? 1 : 0));
    }
    const SubgraphCode code = encode_subgraph(graph);
    REQUIRE(!code.is_explicit);
    REQUIRE(decode_subgraph(code) == graph);
  }
}

TEST_CASE("symbols that fit no graph are refused") {
  using S = AttributeSymbol;
  CHECK(!decode_subgraph({.first = {S::More}, .second = {}, .second_goes_first = {}, .graph = {}}));
  CHECK(
      !decode_subgraph({.first = {S::Merge}, .second = {}, .second_goes_first = {}, .graph = {}}));
  CHECK(!decode_subgraph(
      {.first = {S::Copy}, .second = {S::Copy}, .second_goes_first = {}, .graph = {}}));
}

}  // namespace
}  // namespace crease
