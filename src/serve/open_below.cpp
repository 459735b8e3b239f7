#include "serve/open_below.h"

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace crease::serve {

namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return {};
    const int high = digit_of(text[i + 1]), low = digit_of(text[i + 2]);
    if (high < 0 || low < 0) return {};
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

bool may_be_asked_for(std::string_view name) {
  return !name.empty() && name.front() != '.' &&
         name.find_first_of(std::string_view("/\\\0", 3)) == std::string_view::npos;
}

}  // namespace

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int OpenFile::release() {
  return std::exchange(descriptor_, -1);
}

std::optional<UrlPath> parse_url_path(std::string_view path) {
  if (!path.starts_with('/')) return {};
  path.remove_prefix(1);
  UrlPath parsed;
  parsed.ends_with_slash = path.empty() || path.ends_with('/');
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    std::optional<std::string> name = percent_decoded(path.substr(0, slash));
    if (!name || !may_be_asked_for(*name)) return {};
    parsed.names.push_back(*std::move(name));
    path = slash == std::string_view::npos ? std::string_view{} : path.substr(slash + 1);
  }
  return parsed;
}

std::optional<Opened> open_below(int folder, const std::vector<std::string>& names,
                                 bool follow_symlinks) {
  // What would wait, as a named pipe does, is opened and then refused.
  const int how = O_RDONLY | O_CLOEXEC | O_NONBLOCK | (follow_symlinks ? 0 : O_NOFOLLOW);
  OpenFile at(::openat(folder, ".", O_RDONLY | O_CLOEXEC | O_DIRECTORY));
  for (std::size_t i = 0; at && i < names.size(); ++i) {
    const bool is_last = i + 1 == names.size();
    at = OpenFile(::openat(at.get(), names[i].c_str(), how | (is_last ? 0 : O_DIRECTORY)));
  }
  Opened opened;
  if (!at || ::fstat(at.get(), &opened.facts) != 0) return {};
  if (!S_ISREG(opened.facts.st_mode) && !S_ISDIR(opened.facts.st_mode)) return {};
  opened.file = std::move(at);
  return opened;
}

}  // namespace crease::serve
