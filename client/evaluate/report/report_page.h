// What the reports are made of: pages that need nothing else, with facts and figures.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "schema/base/output_file.h"
#include "schema/drive/drive.h"

namespace milepost {

struct Figure {
  std::string heading;  // plain text
  std::string legend;   // HTML
  std::string drawing;  // HTML; empty when there is nothing to draw
  std::string caption;  // plain text: how to read it, and the numbers behind
};

std::string html_of(const Figure& figure);

// Names, which are HTML, and values, which are plain text.
using Facts = std::vector<std::pair<std::string, std::string>>;

// When the drive was captured, its frames, where it comes from and its licence.
Facts facts_of(const Drive& drive);
std::string title_of(const Drive& drive);  // or what stands for one that has none

struct PageHead {
  std::string kind;   // "evaluation"
  std::string title;  // of this page among its kind
  std::string lead;   // the result in a sentence or two
  Facts facts;
};

// A page of any kind, also of an older version.
extern const OutputKind kReportOutput;

// The whole document, UTF-8; all of `head` is plain text but the names of facts, `content` is HTML.
std::string page(const PageHead& head, const std::string& content);

}  // namespace milepost
