#include <iostream>

#include "client/cli/commands.h"
#include "client/cli/source_options.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/output.h"
#include "client/evaluate/replay.h"
#include "schema/base/file.h"

namespace milepost {
namespace {

std::string summary_line(const std::vector<FrameFix>& fixes, const std::string& out) {
  std::size_t located = 0;
  for (const FrameFix& frame : fixes) located += frame.fix.along_m ? 1 : 0;
  return out + ": " + std::to_string(located) + " of " + std::to_string(fixes.size()) +
         " frames localized";
}

}  // namespace

int run_localize(const std::string& program, std::vector<std::string> words) {
  CLI::App app(
      "Localizes every frame of a drive and writes one fix a frame.\n\n"
      "The start comes from the drive's gps.csv, the motion between frames also from its "
      "odometry.csv where\n"
      "there is one; recorded positions are not looked at.\n"
      "Columns: timestamp_s, filename, status, segment, along_m, sigma_m, latitude_deg, "
      "longitude_deg,\n"
      "matches, latency_ms; then lateral_m (from the segment's line, positive to the right),\n"
      "heading_deg (of the camera, clockwise from north) and lateral_sigma_m, which are empty "
      "where\n"
      "the method does not know them. Latitude and longitude are the camera's where lateral_m is "
      "known,\n"
      "else those of along_m on the segment's line.\n"
      "Example: milepost-client localize --server http://localhost:8080 --cache cache \\\n"
      "           --drive drives/tuesday --out fixes.csv",
      program);
  SourceOptions map;
  std::string folder;
  std::string out;
  std::string method_name = kDefaultMethod;
  add_source_options(app, map);
  app.add_option("--drive", folder, "Folder of the drive to localize")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", out, "File to write the fixes to; old fixes are replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--method", method_name, "How to localize (default " + method_name + ")")
      ->option_text("M");
  if (const auto code = parse_words(app, std::move(words))) return *code;
  if (map.server.empty() && map.map.empty()) {
    std::cerr << program << ": either --server or --map is required; see '" << program
              << " --help'\n";
    return kExitWrongCall;
  }

  const Result<Method> method = method_named(method_name);
  if (!method) return fail(program, method.error());
  const Result<Drive> drive = read_drive(folder);
  if (!drive) return fail(program, drive.error());
  if (const Status free = check_outputs({{"--out", out, &kFixesOutput}}, inputs_of(*drive, map));
      !free) {
    return fail(program, free.error());
  }
  const Result<std::shared_ptr<MapSource>> source = open_source(map);
  if (!source) return fail(program, source.error());
  catch_stop_signals();
  const Result<Replay> replay = [&] {
    ProgressLine progress;
    return replay_drive(*drive, *source, {*method}, false, [&](std::size_t done) {
      progress.show("frame " + std::to_string(done) + " of " +
                    std::to_string(drive->frames.size()));
      return !stop_requested();
    });
  }();
  if (!replay) return fail(program, replay.error());
  const Status written = write_text_file(out, fixes_csv(replay->fixes.front()));
  if (!written.ok()) return fail(program, written.error());
  report_stream(out) << summary_line(replay->fixes.front(), out) << "\n";
  return replay->outage ? fail(program, *replay->outage) : kExitDone;
}

}  // namespace milepost
