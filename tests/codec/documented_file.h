// The file that docs/format.md, which is at `path`, shows in its example.
#pragma once

#include <doctest/doctest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace crease {

// Its hex dump: sixteen bytes a line, behind their offset and before what of them is a letter.
inline std::string documented_dump(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t heading = text.find("\n## Example\n");
  REQUIRE(heading != std::string::npos);
  const std::size_t begin = text.find("```\n", heading) + 4;
  return text.substr(begin, text.find("```", begin) - begin);
}

inline std::vector<std::byte> documented_file(const std::filesystem::path& path) {
  std::istringstream lines(documented_dump(path));
  std::vector<std::byte> bytes;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream numbers(line.substr(4, 3 * 16 + 1));
    for (unsigned byte; numbers >> std::hex >> byte;) bytes.push_back(std::byte(byte));
  }
  return bytes;
}

}  // namespace crease
