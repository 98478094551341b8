#include <optional>
#include <ostream>
#include <utility>

#include "mapper/cli/commands.h"
#include "mapper/report/map_report_data.h"
#include "mapper/report/map_report_json.h"
#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"
#include "schema/page/report_page.h"

namespace milepost {
namespace {

struct ReportOptions {
  std::string map;
  std::string out;
};

constexpr const char* kReportDescription =
    R"(Writes a page by which a map is accepted: the road network to scale, coloured by how well a
fix would know its place there, and all ten metres of each segment with their landmarks, passes,
gaps and the fit of the images; distributions, the findings of the build, and its drives.

The page is one HTML file that loads nothing; any browser shows it.
Example: milepost-mapper report --map maps/town.map --out town.html)";

// How the map came to be, if it tells. Errors: corrupt, io.
Result<std::optional<MappingRecord>> record_of(const MapReader& map) {
  const Result<std::string> document = map.mapping_document();
  if (!document) return document.error();
  if (document->empty()) return std::optional<MappingRecord>();
  Result<MappingRecord> record = mapping_record_from(*document);
  if (record) return std::optional(std::move(*record));
  return Error{record.error().code, map.file().string(), record.error().what, record.error().hint};
}

int write_report(const std::string& program, const ReportOptions& options) {
  const Result<MapReader> map = MapReader::open(options.map);
  if (!map) return fail(program, map.error());
  if (const Status free = check_outputs({{"--out", options.out, &kReportOutput}}, {options.map});
      !free) {
    return fail(program, free.error());
  }
  const auto record = record_of(*map);
  if (!record) return fail(program, record.error());
  const Result<MapReportData> data = map_report_data(*map, *record);
  if (!data) return fail(program, data.error());
  const Status written = write_text_file(options.out, report_page(map_report_json(*data)));
  if (!written) return fail(program, written.error());
  report_stream(options.out) << options.out << ": report of build " << map->build() << "\n";
  return kExitDone;
}

}  // namespace

RunCommand add_report(CLI::App& app) {
  app.description(kReportDescription);
  const auto options = std::make_shared<ReportOptions>();
  app.add_option("--map", options->map, "Map file to read")->required()->option_text("FILE");
  app.add_option("--out", options->out, "Page to write; an existing report is replaced on success")
      ->required()
      ->option_text("FILE");
  return [options, program = name_of(app)] { return write_report(program, *options); };
}

}  // namespace milepost
