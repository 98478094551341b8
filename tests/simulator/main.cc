// milepost-simulator: makes up a street and records drives along it.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "tests/simulator/record.h"
#include "tests/simulator/street.h"

namespace {

using namespace milepost;
using namespace milepost::simulator;

constexpr int kWrongCall = 2;

struct Options {
  std::string out;
  double length_m = 120;
  std::uint64_t seed = 1;
  bool query = false;
};

Progress progress_of(const std::string& name) {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [name](std::size_t index, std::size_t count) {
    std::fprintf(stderr, "\r%s: frame %zu of %zu", name.c_str(), index + 1, count);
    if (index + 1 == count) std::fputc('\n', stderr);
  };
}

Status record_all(const Options& options) {
  StreetPlan plan;
  plan.length_m = options.length_m;
  plan.seed = options.seed;
  const Street street = make_street(plan);
  std::vector<RunPlan> runs = {map_run(plan)};
  if (options.query) runs.push_back(query_run(plan));
  for (const RunPlan& run : runs) {
    const Status status =
        record(street, run, std::filesystem::path(options.out) / run.name, progress_of(run.name));
    if (!status) return status;
  }
  return ok_status();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Makes up a street from a seed and records drives along it, in the drive format: a mapping\n"
      "drive in DIR/street-map and, with --query, a second drive on another line in\n"
      "DIR/street-query. The same seed and length give the same bytes.");
  app.set_version_flag("--version", MILEPOST_VERSION);
  app.add_option("--out", options.out, "Folder for the drives; made if need be")->required();
  app.add_option("--length-m", options.length_m, "Length of the drives in metres")
      ->check(CLI::Range(10.0, 5000.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the street and of all noise")
      ->capture_default_str();
  app.add_flag("--query", options.query, "Record the second drive, too");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongCall;
  }
  const Status status = record_all(options);
  if (status.ok()) return 0;
  std::cerr << "milepost-simulator: " << status.error().line() << "\n";
  return 1;
}
