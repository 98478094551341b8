// Symbol visibility of the shared library.
#pragma once

#if defined(__GNUC__)
#define MILEPOST_PUBLIC __attribute__((visibility("default")))
#define MILEPOST_HIDDEN __attribute__((visibility("hidden")))
#else
#define MILEPOST_PUBLIC
#define MILEPOST_HIDDEN
#endif
