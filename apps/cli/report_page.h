// One page of HTML about a model that needs nothing else: no file, no script, no host.
#pragma once

#include "cli/command.h"
#include "cli/report_levels.h"

#include <string>

namespace crease::cli {

struct PageContent {
  std::string title;
  Json facts;  // file_facts()
  ReportLevels levels;
  std::string import_lines;  // lines_of() of the import, or empty: the model came as a .crease
};

// Well-formed XML as well as HTML; names of the model are escaped.
std::string report_page(const PageContent& content);

}  // namespace crease::cli
