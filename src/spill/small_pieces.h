// Small allocations out of a spill file, of which there may be millions.
//
//   SmallPieces pieces(file);
//   void* piece = pieces.allocate(48);
//   pieces.free(piece);
//
// The standard's pools do the work, over pages of the file; in front of each piece are 16 bytes
// with its size. What is freed is used again and stays in the file. Threads: any.
#pragma once

#include "spill/spill_file.h"

#include <cstddef>
#include <memory_resource>
#include <mutex>
#include <optional>

namespace crease::spill {

class SmallPieces {
 public:
  // `file` serves nobody else; it stays empty until a piece is asked for.
  explicit SmallPieces(SpillFile& file) : pages_(file) {}

  // Aligned as by malloc(). Null: the file has no room.
  [[nodiscard]] void* allocate(std::size_t bytes) noexcept;
  void free(void* piece) noexcept;

 private:
  class Pages final : public std::pmr::memory_resource {
   public:
    explicit Pages(SpillFile& file) : file_(file) {}

   private:
    void* do_allocate(std::size_t bytes, std::size_t alignment) override;
    void do_deallocate(void* memory, std::size_t, std::size_t) override { file_.free(memory); }
    bool do_is_equal(const memory_resource& other) const noexcept override {
      return this == &other;
    }
    SpillFile& file_;
  };

  Pages pages_;
  std::once_flag pools_once_;
  std::optional<std::pmr::synchronized_pool_resource> pools_;
};

}  // namespace crease::spill
