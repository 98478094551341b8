#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>

#include "client/cli/commands.h"
#include "client/cli/source_options.h"
#include "client/evaluate/baselines/methods.h"
#include "client/evaluate/drive_playback.h"
#include "client/evaluate/estimates.h"
#include "client/evaluate/output.h"
#include "client/evaluate/replay.h"
#include "client/evaluate/report/report_data.h"
#include "client/evaluate/tum.h"
#include "schema/base/file.h"
#include "schema/page/report_page.h"

namespace milepost {
namespace {

constexpr const char* kEvaluateDescription =
    R"(Localizes a drive and compares the fixes with its recorded positions.

Writes summary.json, fixes-METHOD.csv and report.html into the output folder.
fixes-METHOD.csv has the columns of localize up to latency_ms; then truth_along_m, error_m, lateral_m,
heading_deg, lateral_sigma_m, truth_lateral_m, lateral_error_m, heading_error_deg, truth_segment,
distance_m (in plan, from the recorded position to the fix) and sigma_map_m.
An error is the fix minus the truth: the nearest point of the segments that the recorded position,
heading and altitude belong to. Arc length and lateral offset are relative to the segment's line,
lateral positive to the right; the true heading is the recorded one. A fix on another road is wrong
by its distance.
Example: milepost-client evaluate --map maps/town.map --drive drives/tuesday --out results \
           --method tracklet-regression-kalman milepost)";

struct EvaluateOptions {
  SourceOptions map;
  std::string drive;
  std::string out;
  std::optional<double> receiver_until_s;
  std::vector<std::string> methods = {kDefaultMethod};
  bool estimates = false;
  std::string tum;
};

Result<std::vector<Method>> methods_named(const std::vector<std::string>& names) {
  std::vector<Method> methods;
  for (const std::string& name : names) {
    Result<Method> method = method_named(name);
    if (!method) return method.error();
    methods.push_back(std::move(*method));
  }
  return methods;
}

// A fix on the segment with the most fixes; null without any.
const Fix* typical_fix(const std::vector<MethodEvaluation>& methods) {
  std::map<std::string, std::size_t> counts;
  const Fix* typical = nullptr;
  std::size_t most = 0;
  for (const MethodEvaluation& method : methods) {
    for (const EvaluatedFix& evaluated : method.fixes) {
      const Fix& fix = evaluated.frame.fix;
      if (!fix.along_m) continue;
      const std::size_t count = ++counts[fix.version.map + "/" + fix.segment];
      if (count > most) {
        most = count;
        typical = &fix;
      }
    }
  }
  return typical;
}

Result<std::string> report_of(const Drive& drive, const std::string& source_name, MapSource& source,
                              const std::vector<MethodEvaluation>& methods) {
  ReportInput input;
  input.map_source = source_name;
  input.drive = &drive;
  input.methods = methods;
  if (const Fix* fix = typical_fix(methods)) {
    input.map_name = fix->version.map + " (build " + fix->version.build + ")";
  }
  Result<std::vector<RoadAround>> roads = roads_around(drive, methods, source);
  if (!roads) return roads.error();
  input.roads = std::move(*roads);
  return report_page(report_data(input));
}

// Writes the files that --estimates adds to an evaluation.
Status write_estimates(const std::filesystem::path& out,
                       const std::vector<MethodEvaluation>& methods, MapSource& source) {
  for (const MethodEvaluation& evaluation : methods) {
    if (!has_estimates(evaluation.fixes)) continue;
    const Status written = write_text_file(
        out / ("estimates-" + evaluation.summary.method + ".csv"), estimates_csv(evaluation.fixes));
    if (!written.ok()) return written;
  }
  const Fix* fix = typical_fix(methods);
  if (!fix) return ok_status();
  const auto regressions = regressions_csv(source, *fix);
  if (!regressions) return regressions.error();
  return *regressions ? write_text_file(out / "regressions.csv", **regressions) : ok_status();
}

// Creates the output folder and checks that all files of the evaluation may be written into it.
Status prepare_outputs(const EvaluateOptions& options, const Drive& drive) {
  const std::filesystem::path out = options.out;
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) {
    return Error{ErrorCode::io, out.string(),
                 "the folder cannot be created (" + error.message() + ")",
                 "give another one with --out"};
  }
  const auto output = [&](const std::string& name, const OutputKind& kind) {
    return Output{"--out", out / name, &kind, "folder"};
  };
  std::vector<Output> outputs = {output("summary.json", kSummaryOutput),
                                 output("report.html", kReportOutput)};
  for (const std::string& method :
       std::set<std::string>(options.methods.begin(), options.methods.end())) {
    outputs.push_back(output("fixes-" + method + ".csv", kFixesOutput));
    if (!options.estimates) continue;
    outputs.push_back(output("estimates-" + method + ".csv", kEstimatesOutput));
  }
  if (options.estimates) outputs.push_back(output("regressions.csv", kRegressionsOutput));
  if (!options.tum.empty()) {
    outputs.push_back({"--tum", options.tum, &kTumOutput});
    outputs.push_back({"--tum", tum_truth_file(options.tum), &kTumOutput});
  }
  return check_outputs(outputs, inputs_of(drive, options.map));
}

// Writes all files of an evaluation; each file is written completely or not at all.
Status write_evaluation(const std::filesystem::path& out,
                        const std::vector<MethodEvaluation>& methods, const std::string& report) {
  for (const MethodEvaluation& evaluation : methods) {
    const Status written = write_text_file(out / ("fixes-" + evaluation.summary.method + ".csv"),
                                           evaluated_fixes_csv(evaluation.fixes));
    if (!written.ok()) return written;
  }
  const Status written = write_text_file(out / "report.html", report);
  if (!written.ok()) return written;
  return write_text_file(out / "summary.json", summary_json(methods));
}

Result<Replay> replay_with_progress(const Drive& drive, const std::shared_ptr<MapSource>& source,
                                    const std::vector<Method>& methods, bool with_estimates) {
  ProgressLine progress;
  return replay_drive(drive, source, methods, with_estimates, [&](std::size_t done) {
    progress.show("frame " + std::to_string(done) + " of " + std::to_string(drive.frames.size()));
    return !stop_requested();
  });
}

int evaluate(const std::string& program, const EvaluateOptions& options) {
  const Result<std::vector<Method>> methods = methods_named(options.methods);
  if (!methods) return fail(program, methods.error());
  Result<Drive> drive = read_drive(options.drive);
  if (!drive) return fail(program, drive.error());
  if (options.receiver_until_s) ignore_receiver_after(*drive, *options.receiver_until_s);
  if (const Status prepared = prepare_outputs(options, *drive); !prepared) {
    return fail(program, prepared.error());
  }
  const Result<std::shared_ptr<MapSource>> source = open_source(options.map);
  if (!source) return fail(program, source.error());
  catch_stop_signals();
  const Result<Replay> replay = replay_with_progress(*drive, *source, *methods, options.estimates);
  if (!replay) return fail(program, replay.error());

  std::vector<MethodEvaluation> evaluations;
  for (std::size_t m = 0; m < methods->size(); ++m) {
    const Method& method = (*methods)[m];
    Result<MethodEvaluation> evaluation =
        evaluate_fixes(method.name, method.layer, *drive, replay->fixes[m], **source);
    if (!evaluation) return fail(program, evaluation.error());
    evaluations.push_back(std::move(*evaluation));
  }
  const Result<std::string> report = report_of(*drive, options.map.name(), **source, evaluations);
  if (!report) return fail(program, report.error());
  const Status written = write_evaluation(options.out, evaluations, *report);
  if (!written.ok()) return fail(program, written.error());
  if (options.estimates) {
    const Status more = write_estimates(options.out, evaluations, **source);
    if (!more.ok()) return fail(program, more.error());
  }
  if (!options.tum.empty()) {
    Status more = write_text_file(options.tum, tum_text(replay->fixes.front(), *drive));
    if (more) more = write_text_file(tum_truth_file(options.tum), tum_truth_text(*drive));
    if (!more) return fail(program, more.error());
  }
  std::cout << summary_text(evaluations);
  return replay->outage ? fail(program, *replay->outage) : kExitDone;
}

}  // namespace

RunCommand add_evaluate(CLI::App& app) {
  app.description(kEvaluateDescription);
  const auto options = std::make_shared<EvaluateOptions>();
  std::string known;
  for (const std::string& name : method_names()) known += (known.empty() ? "" : ", ") + name;
  add_source_options(app, options->map);
  app.add_option("--drive", options->drive, "Folder of the drive to localize")
      ->required()
      ->option_text("DIR");
  add_receiver_option(app, options->receiver_until_s);
  app.add_option("--tum", options->tum,
                 "Also write the poses of the first method as lines 'timestamp tx ty tz qx qy qz "
                 "qw', camera\naxes in the drive's tangent frame or that of its first frame, and "
                 "the recorded ones\nbeside it: run.tum and run-truth.tum")
      ->option_text("FILE");
  app.add_option("--out", options->out,
                 "Folder to write to, created if missing; earlier results are replaced")
      ->required()
      ->option_text("DIR");
  app.add_option("--method", options->methods, "Methods to compare: " + known)
      ->option_text("M ... [milepost]");
  app.add_flag(
      "--estimates", options->estimates,
      "Also write estimates-METHOD.csv, the estimate of each matched tracklet in each frame, and\n"
      "regressions.csv, the observations of some tracklets, if the map was built with --lab");
  app.callback([options] { require_source(options->map); });
  return [options, program = name_of(app)] { return evaluate(program, *options); };
}

}  // namespace milepost
