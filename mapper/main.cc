#include "mapper/cli/aerial_command.h"
#include "mapper/cli/build_command.h"
#include "mapper/cli/export_command.h"
#include "schema/command/command.h"

int main(int argc, char** argv) {
  return milepost::run_program(
      "milepost-mapper", "Turns recorded drives into maps for camera localization.",
      {{"build", "recorded drives -> a map file", milepost::run_build},
       {"aerial", "an orthoimage or building footprints -> the walls of a map",
        milepost::run_aerial},
       {"export", "walls or segments of a map -> a GeoJSON file", milepost::run_export}},
      argc, argv);
}
