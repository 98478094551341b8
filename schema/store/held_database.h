// SQLite on files that are held open.
#pragma once

namespace milepost::sqlite {

// The name of a virtual file system that reads from a descriptor: a URI file:PATH?immutable=1&fd=N
// opens what N holds, whatever lies at the path. The descriptor must stay open as long as the
// connection. Null if SQLite has no memory left.
const char* held_file_system();

}  // namespace milepost::sqlite
