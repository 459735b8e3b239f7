#include "http/url.h"

#include "crease/http_source.h"

namespace crease {

bool is_http_url(std::string_view text) {
  return text.starts_with("http://") || text.starts_with("https://");
}

namespace http {

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
