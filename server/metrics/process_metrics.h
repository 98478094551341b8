// What every program tells Prometheus of its process.
#pragma once

#include <vector>

namespace milepost::server {

struct ProcessNumber {
  const char* name;
  const char* help;
  double value;
};

// Memory, descriptors, time of start. Those that the system does not tell are left out.
std::vector<ProcessNumber> process_numbers();

}  // namespace milepost::server
