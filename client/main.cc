#include "client/cli/commands.h"
#include "schema/command/command.h"

int main(int argc, char** argv) {
  return milepost::run_program(
      "milepost-client", "Localizes a camera vehicle on mapped roads.",
      {{"localize", "a drive -> one fix a frame", milepost::run_localize},
       {"evaluate", "a drive with known positions -> how well it is localized",
        milepost::run_evaluate},
       {"vanishing", "images -> the directions of the edges of buildings",
        milepost::run_vanishing}},
      argc, argv);
}
