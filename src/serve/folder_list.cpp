#include "serve/folder_list.h"

#include "serve/file_answer.h"
#include "serve/open_below.h"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

namespace crease::serve {

namespace {

std::string html_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string percent_encoded(std::string_view name) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.' || c == '~';
    if (is_plain) {
      encoded += c;
    } else {
      encoded += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
  }
  return encoded;
}

std::string url_of(const ListedFile& file) {
  return percent_encoded(file.name) + (file.is_folder ? "/" : "");
}

struct FolderCloser {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

}  // namespace

std::vector<ListedFile> list_folder(int folder, bool follow_symlinks) {
  std::vector<ListedFile> files;
  OpenFile copy(::openat(folder, ".", O_RDONLY | O_CLOEXEC | O_DIRECTORY));
  const std::unique_ptr<DIR, FolderCloser> open(::fdopendir(copy.get()));
  if (!open) return files;
  copy.release();
  while (const dirent* entry = ::readdir(open.get())) {
    const std::string name = entry->d_name;
    if (name.front() == '.' || name.find('\\') != std::string::npos) continue;
    const std::optional<Opened> opened = open_below(folder, {name}, follow_symlinks);
    if (!opened) continue;
    const bool is_folder = opened->is_folder();
    if (!is_folder && !name.ends_with(".crease")) continue;
    files.push_back({name, is_folder,
                     is_folder ? 0 : static_cast<std::uint64_t>(opened->facts.st_size),
                     http_date(opened->facts.st_mtime)});
  }
  std::ranges::sort(files, {}, [](const ListedFile& file) {
    return std::tuple(!file.is_folder, std::string_view(file.name));
  });
  return files;
}

std::string list_as_html(std::string_view path, const std::vector<ListedFile>& files) {
  std::string page = "<!doctype html>\n<meta charset=\"utf-8\">\n<title>" + html_text(path) +
                     "</title>\n<style>body{font:16px sans-serif;margin:2em}td{padding:0 2em 0 0}"
                     "td:nth-child(2){text-align:right}</style>\n<h1>" +
                     html_text(path) + "</h1>\n<table>\n";
  if (path != "/") page += "<tr><td><a href=\"..\">..</a></td></tr>\n";
  for (const ListedFile& file : files) {
    page += "<tr><td><a href=\"" + url_of(file) + "\">" + html_text(file.name) +
            (file.is_folder ? "/" : "") + "</a></td><td>" +
            (file.is_folder ? "" : std::to_string(file.bytes)) + "</td><td>" +
            html_text(file.last_modified) + "</td></tr>\n";
  }
  return page + "</table>\n";
}

std::string list_as_json(std::string_view path, const std::vector<ListedFile>& files) {
  nlohmann::ordered_json json = {{"folder", path},
                                 {"folders", nlohmann::ordered_json::array()},
                                 {"files", nlohmann::ordered_json::array()}};
  for (const ListedFile& file : files) {
    nlohmann::ordered_json one = {{"name", file.name}, {"url", url_of(file)}};
    if (!file.is_folder) {
      one["bytes"] = file.bytes;
      one["last_modified"] = file.last_modified;
    }
    json[file.is_folder ? "folders" : "files"].push_back(std::move(one));
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace crease::serve
