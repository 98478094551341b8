#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <thread>

#include <opencv2/core/utility.hpp>

#include "mapper/cli/commands.h"
#include "mapper/codebook/codebook.h"
#include "mapper/pipeline/codebook_training.h"
#include "schema/base/file.h"
#include "schema/base/output_file.h"
#include "schema/command/command.h"

namespace milepost {
namespace {

constexpr const char* kCodebookDescription =
    R"(Trains a codebook on recorded drives.

A map's descriptors are compacted with a codebook: the principal axes of SIFT descriptors. One ships
with milepost. Maps whose codebooks differ cannot share landmarks across their border.
Example: milepost-mapper codebook --drive drives/monday --name night-1 --out night.json
         milepost-mapper build --drive drives/monday --codebook night.json --map maps/town.map)";

struct CodebookOptions {
  std::vector<std::string> drives;
  std::string out;
  std::string version = "trained";
  int frames = 64;
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
};

bool begins_codebook(std::string_view head) { return begins_without_space(head, R"({"version":)"); }

constexpr OutputKind kCodebookOutput = {"a codebook", begins_codebook, true};

int make_codebook(const std::string& program, const CodebookOptions& options) {
  if (!is_segment_id(options.version)) {
    fail(program, {ErrorCode::invalid_input, "--name", "'" + options.version + "' is not an id",
                   "use 1 to 64 letters, digits, '.', '_' or '-'"});
    return kExitWrongCall;
  }
  std::vector<Drive> drives;
  std::vector<std::filesystem::path> inputs;
  for (const std::string& folder : options.drives) {
    Result<Drive> drive = read_drive(folder);
    if (!drive) return fail(program, drive.error());
    std::ranges::copy(files_of(*drive), std::back_inserter(inputs));
    drives.push_back(std::move(*drive));
  }
  if (const Status free = check_outputs({{"--out", options.out, &kCodebookOutput}}, inputs); !free)
    return fail(program, free.error());
  cv::setNumThreads(1);  // one frame per thread
  const BuildSettings settings;
  const Result<BuildPlan> plan = plan_build(drives, settings, options.jobs);
  if (!plan) return fail(program, plan.error());
  const Result<PcaProjection> codebook =
      trained_codebook(plan->drives, settings, static_cast<std::size_t>(options.frames),
                       options.version, options.jobs);
  if (!codebook) return fail(program, codebook.error());
  if (const Status written = write_text_file(options.out, codebook_text(*codebook)); !written)
    return fail(program, written.error());
  std::cout << options.out << ": codebook " << options.version << "\n";
  return kExitDone;
}

}  // namespace

RunCommand add_codebook(CLI::App& app) {
  app.description(kCodebookDescription);
  const auto options = std::make_shared<CodebookOptions>();
  app.add_option("--drive", options->drives, "Folder of a recorded drive; may be repeated")
      ->required()
      ->option_text("DIR");
  app.add_option("--out", options->out, "Codebook file to write")->required()->option_text("FILE");
  app.add_option("--name", options->version, "Name of the codebook (default trained)")
      ->option_text("ID");
  add_number(app, "--frames", options->frames, "N", "Frames to train on, spread over all drives", 1,
             10000);
  add_number(app, "--jobs", options->jobs, "N", "Threads that extract features", 1, 256);
  return [options, program = name_of(app)] { return make_codebook(program, *options); };
}

}  // namespace milepost
