#include "client/cli/commands.h"

int main(int argc, char** argv) {
  return milepost::run_program("milepost-client", "Localizes a camera vehicle on mapped roads.",
                               {{"localize", milepost::add_localize},
                                {"evaluate", milepost::add_evaluate},
                                {"find", milepost::add_find},
                                {"vanishing", milepost::add_vanishing}},
                               argc, argv);
}
