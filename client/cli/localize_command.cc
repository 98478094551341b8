#include <iostream>
#include <optional>

#include "client/cli/commands.h"
#include "client/cli/source_options.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/drive_playback.h"
#include "client/evaluate/output.h"
#include "client/evaluate/replay.h"
#include "client/evaluate/tum.h"
#include "schema/base/file.h"

namespace milepost {
namespace {

constexpr const char* kLocalizeDescription =
    R"(Localizes a drive and writes one fix per frame.

It starts from the drive's gps.csv and uses its odometry.csv, if there is one, between frames;
recorded positions are ignored.
Columns: timestamp_s, filename, status, segment, along_m, sigma_m, latitude_deg, longitude_deg,
matches, latency_ms, lateral_m (from the segment's line, positive to the right), heading_deg (of the
camera, clockwise from north), lateral_sigma_m and sigma_map_m; the three before the last are empty
where the method does not estimate them. The sigmas hold in the world; sigma_map_m is that of
along_m against the map, as if the map's own positions were exact. Latitude and longitude are the
camera's where lateral_m is given, otherwise those of along_m on the segment's line; off the map they
are where the motion carries the camera, with the deviation in plan as sigma_m, while that is below
30 m.
Example: milepost-client localize --server http://localhost:8080 --cache cache \
           --drive drives/tuesday --out fixes.csv)";

struct LocalizeOptions {
  SourceOptions map;
  std::string drive;
  std::string out;
  std::string tum;
  std::optional<double> receiver_until_s;
  std::string method = kDefaultMethod;
};

std::string summary_line(const std::vector<FrameFix>& fixes, const std::string& out) {
  std::size_t located = 0;
  for (const FrameFix& frame : fixes) located += frame.fix.along_m ? 1 : 0;
  return out + ": " + std::to_string(located) + " of " + std::to_string(fixes.size()) +
         " frames localized";
}

int localize(const std::string& program, const LocalizeOptions& options) {
  const Result<Method> method = method_named(options.method);
  if (!method) return fail(program, method.error());
  Result<Drive> drive = read_drive(options.drive);
  if (!drive) return fail(program, drive.error());
  if (options.receiver_until_s) ignore_receiver_after(*drive, *options.receiver_until_s);
  std::vector<Output> outputs = {{"--out", options.out, &kFixesOutput}};
  if (!options.tum.empty()) outputs.push_back({"--tum", options.tum, &kTumOutput});
  if (const Status free = check_outputs(outputs, inputs_of(*drive, options.map)); !free) {
    return fail(program, free.error());
  }
  const Result<std::shared_ptr<MapSource>> source = open_source(options.map);
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
  const Status written = write_text_file(options.out, fixes_csv(replay->fixes.front()));
  if (!written.ok()) return fail(program, written.error());
  if (!options.tum.empty()) {
    const Status more = write_text_file(options.tum, tum_text(replay->fixes.front(), *drive));
    if (!more) return fail(program, more.error());
  }
  report_stream(options.out) << summary_line(replay->fixes.front(), options.out) << "\n";
  return replay->outage ? fail(program, *replay->outage) : kExitDone;
}

}  // namespace

RunCommand add_localize(CLI::App& app) {
  app.description(kLocalizeDescription);
  const auto options = std::make_shared<LocalizeOptions>();
  add_source_options(app, options->map);
  app.add_option("--drive", options->drive, "Folder of the drive to localize")
      ->required()
      ->option_text("DIR");
  add_receiver_option(app, options->receiver_until_s);
  app.add_option("--out", options->out, "File to write the fixes to; old fixes are replaced")
      ->required()
      ->option_text("FILE");
  app.add_option("--tum", options->tum,
                 "Also write the camera's poses as lines 'timestamp tx ty tz qx qy qz qw': camera\n"
                 "axes in the drive's tangent frame, or that of its first frame")
      ->option_text("FILE");
  app.add_option("--method", options->method, "How to localize (default " + options->method + ")")
      ->option_text("M");
  app.callback([options] { require_source(options->map); });
  return [options, program = name_of(app)] { return localize(program, *options); };
}

}  // namespace milepost
