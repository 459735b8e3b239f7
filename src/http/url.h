// URLs of hosts, and what of them may be printed.
#pragma once

#include <string>
#include <string_view>

namespace crease::http {

// Without user, password, query and fragment, which may be secrets.
std::string printable_url(std::string_view url);

}  // namespace crease::http
