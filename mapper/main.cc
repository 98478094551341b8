#include "mapper/cli/commands.h"

int main(int argc, char** argv) {
  return milepost::run_program("milepost-mapper",
                               "Turns recorded drives into maps for camera localization.",
                               {{"import", milepost::add_import},
                                {"build", milepost::add_build},
                                {"codebook", milepost::add_codebook},
                                {"aerial", milepost::add_aerial},
                                {"inspect", milepost::add_inspect},
                                {"report", milepost::add_report},
                                {"verify", milepost::add_verify},
                                {"export", milepost::add_export}},
                               argc, argv);
}
