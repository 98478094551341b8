// How many files and connections the process may hold open, and for what.
#pragma once

#include <cstddef>

namespace milepost::server {

// Raises the soft limit of open descriptors to the hard one, and returns it.
std::size_t raise_descriptor_limit();

// A quarter is for map files that are held open, an eighth for those of maps in memory, which may
// be others; the rest is for connections.
struct DescriptorShares {
  std::size_t held_files = 0;
  std::size_t open_maps = 0;
};
DescriptorShares shares_of(std::size_t descriptors);

}  // namespace milepost::server
