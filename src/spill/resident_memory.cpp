#include "spill/resident_memory.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>

namespace crease::spill {

ResidentMemory resident_memory() {
  const int descriptor = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  char text[128] = {};
  const ssize_t got = ::read(descriptor, text, sizeof text - 1);
  ::close(descriptor);
  std::uint64_t pages = 0, shared = 0;  // all of the process, resident, of files
  if (got <= 0 || std::sscanf(text, "%*u %" SCNu64 " %" SCNu64, &pages, &shared) != 2) return {};
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {(pages - std::min(shared, pages)) * page, shared * page};
}

}  // namespace crease::spill
