#include "server/metrics/metrics.h"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "server/metrics/process_metrics.h"

namespace milepost::server {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr const char* kOther = "other";  // the route of requests that fit none

double number(std::uint64_t count) { return static_cast<double>(count); }

ClientMetric labelled(std::vector<ClientMetric::Label> labels) {
  ClientMetric metric;
  metric.label = std::move(labels);
  return metric;
}

void add_counter(MetricFamily& family, std::vector<ClientMetric::Label> labels, double value) {
  ClientMetric metric = labelled(std::move(labels));
  metric.counter.value = value;
  family.metric.push_back(std::move(metric));
}

void add_gauge(MetricFamily& family, std::vector<ClientMetric::Label> labels, double value) {
  ClientMetric metric = labelled(std::move(labels));
  metric.gauge.value = value;
  family.metric.push_back(std::move(metric));
}

MetricFamily gauge(const std::string& name, const std::string& help, double value) {
  MetricFamily family{name, help, MetricType::Gauge, {}};
  add_gauge(family, {}, value);
  return family;
}

void add_catalog(const Catalog& catalog, std::vector<MetricFamily>& families) {
  std::size_t old_builds = 0;
  for (const auto& [map, builds] : catalog.old_builds()) old_builds += builds.size();
  families.push_back(
      gauge("milepost_maps", "Maps that are served.", number(catalog.maps().size())));
  families.push_back(gauge("milepost_maps_left_out",
                           "Map files that cannot be served; see /readyz.",
                           number(catalog.left_out())));
  families.push_back(gauge("milepost_old_builds",
                           "Builds that were replaced a short time ago and are still served.",
                           number(old_builds)));
  MetricFamily damaged{"milepost_map_damaged",
                       "1 for each build whose file was damaged after it was opened.",
                       MetricType::Gauge,
                       {}};
  for (const auto& [build, error] : catalog.faults())
    add_gauge(damaged, {{"map", build.first}, {"build", build.second}}, 1);
  families.push_back(std::move(damaged));
}

}  // namespace

Metrics::Metrics(const std::vector<std::string_view>& routes) {
  for (const std::string_view route : routes) routes_.try_emplace(std::string(route));
  routes_.try_emplace(kOther);
}

Metrics::RouteCount& Metrics::route_of(std::string_view route) {
  const auto found = routes_.find(route);
  return found == routes_.end() ? routes_.find(kOther)->second : found->second;
}

void Metrics::count(const SentResponse& response) {
  constexpr auto kRelaxed = std::memory_order_relaxed;
  RouteCount& route = route_of(response.route);
  if (response.status < route.by_status.size())
    route.by_status[response.status].fetch_add(1, kRelaxed);
  const double took_s = std::chrono::duration<double>(response.took).count();
  const auto bucket = std::ranges::lower_bound(kBucketsS, took_s) - kBucketsS.begin();
  route.by_duration[static_cast<std::size_t>(bucket)].fetch_add(1, kRelaxed);
  route.nanoseconds.fetch_add(static_cast<std::uint64_t>(response.took.count()), kRelaxed);
  route.bytes.fetch_add(response.body_bytes, kRelaxed);
  if (response.aborted) aborted_.fetch_add(1, kRelaxed);
  if (response.tiles == 0) return;
  const std::lock_guard lock(mutex_);
  auto map = maps_.find(response.map);
  if (map == maps_.end()) map = maps_.try_emplace(std::string(response.map)).first;
  map->second.tiles += response.tiles;
  map->second.bytes += response.body_bytes;
}

void Metrics::add(const std::string& name, const std::string& help, Kind kind,
                  std::function<double()> value) {
  const std::lock_guard lock(mutex_);
  sources_.push_back({name, help, kind, std::move(value)});
}

std::string Metrics::text(const Catalog& catalog) const {
  MetricFamily requests{
      "milepost_http_requests_total", "Responses, by route and status.", MetricType::Counter, {}};
  MetricFamily bytes{"milepost_http_response_bytes_total",
                     "Bytes of responses' bodies, by route.",
                     MetricType::Counter,
                     {}};
  MetricFamily durations{"milepost_http_request_duration_seconds",
                         "From a whole request to the last byte of its response, by route.",
                         MetricType::Histogram,
                         {}};
  for (const auto& [route, count] : routes_) {
    ClientMetric histogram = labelled({{"route", route}});
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < count.by_duration.size(); ++i) {
      below += count.by_duration[i];
      const double bound =
          i < kBucketsS.size() ? kBucketsS[i] : std::numeric_limits<double>::infinity();
      histogram.histogram.bucket.push_back({below, bound});
    }
    if (below == 0) continue;  // not asked for yet
    histogram.histogram.sample_count = below;
    histogram.histogram.sample_sum = number(count.nanoseconds) * 1e-9;
    durations.metric.push_back(std::move(histogram));
    add_counter(bytes, {{"route", route}}, number(count.bytes));
    for (std::size_t status = 0; status < count.by_status.size(); ++status) {
      const std::uint64_t sent = count.by_status[status];
      if (sent > 0)
        add_counter(requests, {{"route", route}, {"status", std::to_string(status)}}, number(sent));
    }
  }
  MetricFamily tiles{
      "milepost_map_tiles_total", "Tiles and cells sent, by map.", MetricType::Counter, {}};
  MetricFamily tile_bytes{"milepost_map_tile_bytes_total",
                          "Bytes of tiles and cells sent, by map.",
                          MetricType::Counter,
                          {}};
  const std::lock_guard lock(mutex_);
  for (const auto& [map, count] : maps_) {
    add_counter(tiles, {{"map", map}}, number(count.tiles));
    add_counter(tile_bytes, {{"map", map}}, number(count.bytes));
  }
  MetricFamily aborted{"milepost_http_responses_aborted_total",
                       "Responses that a client did not take to the end.",
                       MetricType::Counter,
                       {}};
  add_counter(aborted, {}, number(aborted_));
  std::vector<MetricFamily> families = {std::move(requests),  std::move(bytes),
                                        std::move(durations), std::move(aborted),
                                        std::move(tiles),     std::move(tile_bytes)};
  add_catalog(catalog, families);
  for (const Source& source : sources_) {
    const bool is_counter = source.kind == Kind::counter;
    MetricFamily family{
        source.name, source.help, is_counter ? MetricType::Counter : MetricType::Gauge, {}};
    (is_counter ? add_counter : add_gauge)(family, {}, source.value());
    families.push_back(std::move(family));
  }
  MetricFamily version{"milepost_build_info", "1; the program's version.", MetricType::Gauge, {}};
  add_gauge(version, {{"version", MILEPOST_VERSION}}, 1);
  families.push_back(std::move(version));
  for (const ProcessNumber& each : process_numbers())
    families.push_back(gauge(each.name, each.help, each.value));
  std::erase_if(families, [](const MetricFamily& family) { return family.metric.empty(); });
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace milepost::server
