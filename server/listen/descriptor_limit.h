// How many file descriptors, and so connections, this process may have.
#pragma once

#include <cstddef>

namespace milepost::server {

// Raises the soft limit of open descriptors (RLIMIT_NOFILE) to the hard one. Returns the limit.
std::size_t raise_descriptor_limit();

// Map files that are held open, and files of maps in memory, which may be others.
struct MapDescriptors {
  std::size_t held_files = 0;
  std::size_t open_maps = 0;
};
// An eighth of all for files that are held, a sixteenth for maps in memory, up to 256.
MapDescriptors map_descriptors_within(std::size_t descriptor_limit);

// The connections for which there are descriptors: three quarters of those that are free, at least
// one and at most 65536. The rest is for the files of maps and for connections that are rejected.
std::size_t connections_within(std::size_t descriptor_limit);

}  // namespace milepost::server
