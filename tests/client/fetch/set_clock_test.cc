// The system time is changed while a source is in use. This program's own clock_gettime replaces
// the C library's, so that the library under test reads clocks controlled by the test.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>

#include "client/fetch/http_source.h"
#include "tests/client/fetch/fake_map.h"
#include "tests/support/scripted_server.h"
#include "tests/support/temp_folder.h"

namespace {

std::atomic<long> time_of_day_is_off_s = 0;
std::atomic<long> time_passed_s = 0;

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* now) {
  const long code = ::syscall(SYS_clock_gettime, clock, now);
  const bool is_time_of_day = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
  now->tv_sec += time_passed_s + (is_time_of_day ? time_of_day_is_off_s.load() : 0);
  return static_cast<int>(code);
}

namespace milepost::testing {
namespace {

TEST(SetClock, AServerIsAskedAgainWhateverTheTimeOfDay) {
  for (const long step_s : {-3600L, -50L * 365 * 86400, 3600L, 0L}) {
    SCOPED_TRACE(step_s);
    time_of_day_is_off_s = 0;
    const FakeMap map;
    std::atomic<bool> away = false;
    ScriptedServer server([&](const std::string& target) -> ScriptedAnswer {
      return away ? ScriptedAnswer{.status = 503} : map.answer(target);
    });
    const TempFolder cache;
    HttpSourceSettings settings;
    settings.server_url = server.url();
    settings.cache_directory = cache.path();
    const auto source = std::move(open_http_source(settings)).value();
    ASSERT_TRUE(source->segment(map.version(), "s1").ok());
    const GeoPoint position{49.0001, 8.4, 0};
    away = true;
    ASSERT_TRUE(source->segments_near(position, 50).ok());
    const std::size_t before = server.requests().size();
    ASSERT_TRUE(source->segments_near(position, 50).ok());
    EXPECT_EQ(server.requests().size(), before);  // the pause

    away = false;
    time_of_day_is_off_s = step_s;
    time_passed_s += 6;
    ASSERT_TRUE(source->segments_near(position, 50).ok());
    EXPECT_EQ(server.requests().size(), before + 1);
  }
}

}  // namespace
}  // namespace milepost::testing
