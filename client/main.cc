#include "client/cli/commands.h"
#include "schema/command/command.h"

int main(int argc, char** argv) {
  return milepost::run_program(
      "milepost-client", "Localizes a camera vehicle on mapped roads.",
      {{"localize", "a drive -> one fix a frame", milepost::run_localize},
       {"evaluate", "a drive with known positions -> how well it is localized",
        milepost::run_evaluate},
       {"find", "a drive without a receiver -> where it is among the walls of an area",
        milepost::run_find},
       {"vanishing", "images -> the directions of the edges of buildings",
        milepost::run_vanishing}},
      argc, argv);
}
