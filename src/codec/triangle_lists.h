// The triangles at each vertex, in lists that grow and shrink side by side in one array.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace crease::codec {

// A list that outgrows its room moves to the end, with room for half as many again; so all of them
// take at most a few times what they hold. Spans are good until the next add().
class TriangleLists {
 public:
  std::span<const std::uint32_t> operator[](std::uint32_t vertex) const {
    const List& list = lists_[vertex];
    return {triangles_.data() + list.first, list.count};
  }
  // Where the list of the vertex is, not yet what is in it.
  void prefetch(std::uint32_t vertex) const { __builtin_prefetch(&lists_[vertex]); }
  void add_vertex() { lists_.push_back({}); }
  void resize(std::size_t vertices) { lists_.resize(vertices); }
  // Every triangle at each of its corners, in order, with room for some more.
  void fill(std::size_t vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
            std::uint32_t spare) {
    lists_.assign(vertices, {0, 0, spare});
    for (const auto& corners : triangles) {
      for (const std::uint32_t v : corners) ++lists_[v].room;
    }
    std::size_t first = 0;
    for (List& list : lists_) {
      list.first = first;
      first += list.room;
    }
    triangles_.resize(first);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (const std::uint32_t v : triangles[t]) {
        triangles_[lists_[v].first + lists_[v].count++] = t;
      }
    }
  }

  void add(std::uint32_t vertex, std::uint32_t triangle) {
    List& list = lists_[vertex];
    if (list.count == list.room) move(list);
    triangles_[list.first + list.count++] = triangle;
  }
  void add(std::uint32_t vertex, std::span<const std::uint32_t> triangles) {
    const std::size_t count = lists_[vertex].count;
    std::copy(triangles.begin(), triangles.end(), replace(vertex, count, count, triangles.size()));
  }
  // Before the one that is there now at `place`, or at the end.
  void insert(std::uint32_t vertex, std::size_t place, std::uint32_t triangle) {
    *replace(vertex, place, place, 1) = triangle;
  }
  // The same ones in another order.
  void reorder(std::uint32_t vertex, std::span<const std::uint32_t> order) {
    std::copy(order.begin(), order.end(),
              triangles_.begin() + static_cast<std::ptrdiff_t>(lists_[vertex].first));
  }
  template <typename Is>
  void remove_if(std::uint32_t vertex, const Is& is) {
    List& list = lists_[vertex];
    std::uint32_t* const first = triangles_.data() + list.first;
    list.count = static_cast<std::uint32_t>(std::remove_if(first, first + list.count, is) - first);
  }
  void remove(std::uint32_t vertex, std::uint32_t triangle) {
    List& list = lists_[vertex];
    std::uint32_t* const first = triangles_.data() + list.first;
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < list.count; ++i) {  // without a branch that nobody can foretell
      first[left] = first[i];
      left += first[i] != triangle;
    }
    list.count = left;
  }
  // Those from `first` to `last` make room for `count` others, which the caller writes.
  std::uint32_t* replace(std::uint32_t vertex, std::size_t first, std::size_t last,
                         std::size_t count) {
    List& list = lists_[vertex];
    const std::size_t after = list.count - last, size = first + count + after;
    while (list.room < size) move(list);
    std::uint32_t* const begin = triangles_.data() + list.first;
    std::memmove(begin + first + count, begin + last, after * sizeof(std::uint32_t));
    list.count = static_cast<std::uint32_t>(size);
    return begin + first;
  }
  void clear(std::uint32_t vertex) { lists_[vertex].count = 0; }

 private:
  struct List {
    std::size_t first = 0;
    std::uint32_t count = 0, room = 0;
  };

  void move(List& list) {
    const std::size_t first = triangles_.size();
    list.room += list.room / 2 + 8;
    triangles_.resize(first + list.room);
    std::copy_n(triangles_.begin() + static_cast<std::ptrdiff_t>(list.first), list.count,
                triangles_.begin() + static_cast<std::ptrdiff_t>(first));
    list.first = first;
  }

  std::vector<List> lists_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace crease::codec
