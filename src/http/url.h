// URLs of hosts, and what of them may be printed.
#pragma once

#include <string>
#include <string_view>

namespace crease::http {

// As a host wants it: the scheme in small letters; blanks and letters beyond ASCII, as they are
// copied from a browser, as %20 and the like behind the host's name. What is in that way already
// stays.
std::string url_to_ask(std::string_view url);

// Without user, password, query and fragment, which may be secrets.
std::string printable_url(std::string_view url);

}  // namespace crease::http
