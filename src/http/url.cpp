#include "http/url.h"

#include "crease/http_source.h"

#include <algorithm>
#include <cstddef>

namespace crease {

namespace {

char lowered(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

bool starts_with_scheme(std::string_view text, std::string_view scheme) {
  return std::equal(
      scheme.begin(), scheme.end(), text.begin(),
      text.begin() + static_cast<std::ptrdiff_t>(std::min(scheme.size(), text.size())),
      [](char a, char b) { return a == lowered(b); });
}

}  // namespace

bool is_http_url(std::string_view text) {
  return starts_with_scheme(text, "http://") || starts_with_scheme(text, "https://");
}

namespace http {

std::string url_to_ask(std::string_view url) {
  const std::size_t scheme = std::min(url.find("://"), url.size());
  const std::size_t path = std::min(url.find_first_of("/?", scheme + 3), url.size());
  std::string asked;
  for (std::size_t i = 0; i < url.size(); ++i) {
    const auto byte = static_cast<unsigned char>(url[i]);
    const bool is_plain = byte > 0x20 && byte < 0x7f;
    if (i < scheme) {
      asked += lowered(url[i]);
    } else if (i < path || is_plain) {
      asked += url[i];
    } else {
      constexpr std::string_view kDigits = "0123456789ABCDEF";
      asked += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return asked;
}

std::string printable_url(std::string_view url) {
  std::string_view rest = url.substr(0, url.find_first_of("?#"));
  const std::size_t slashes = rest.find("://");
  if (slashes == std::string_view::npos) return std::string(rest);
  const std::size_t begin = slashes + 3;
  const std::string_view authority = rest.substr(begin, rest.find('/', begin) - begin);
  const std::size_t at = authority.rfind('@');
  std::string printable(rest.substr(0, begin));
  printable += rest.substr(at == std::string_view::npos ? begin : begin + at + 1);
  return printable;
}

}  // namespace http

}  // namespace crease
