// The distributions of the report of a map.
#include "mapper/report/histogram.h"
#include "mapper/report/map_report_parts.h"

namespace milepost {
namespace {

struct PerStretch {
  std::vector<double> landmarks_per_m;
  std::vector<double> sigma_m;
  std::vector<double> sigma_map_m;
};

PerStretch per_stretch(const MapReportData& data) {
  PerStretch values;
  for (const SegmentReport& segment : data.segments) {
    for (const MapStretch& stretch : segment.stretches) {
      values.landmarks_per_m.push_back(static_cast<double>(stretch.landmarks) / stretch.length_m());
      if (stretch.sigma_world_m) values.sigma_m.push_back(*stretch.sigma_world_m);
      if (stretch.sigma_map) values.sigma_map_m.push_back(stretch.sigma_map->worse_m());
    }
  }
  return values;
}

}  // namespace

Json histograms_part(const MapReportData& data) {
  const PerStretch values = per_stretch(data);
  const LandmarkFigures& landmarks = data.landmarks;
  const std::vector<Figure> figures = {
      histogram_figure(
          "\u03C3 of a fix", "Of each ten metres, where the least is known.",
          {"\u03C3 (m)", "stretches"},
          {{"in the world", "m0", values.sigma_m}, {"against the map", "m1", values.sigma_map_m}}),
      histogram_figure("Landmarks a metre", "Of each ten metres.",
                       {"landmarks a metre", "stretches"},
                       {{"stretches", "m2", values.landmarks_per_m}}),
      histogram_figure("Drives that saw a landmark",
                       "Where drives agree. A drive that passes twice counts twice.",
                       {"drives", "landmarks", true}, {{"landmarks", "m3", landmarks.drives}}),
      histogram_figure("Length of tracks",
                       "The road between the first and the last image that showed a landmark.",
                       {"metres of road", "landmarks"}, {{"landmarks", "m5", landmarks.track_m}}),
      histogram_figure("Distance of landmarks", "From where a landmark was mapped.",
                       {"distance (m)", "landmarks"}, {{"landmarks", "m6", landmarks.distance_m}}),
      histogram_figure("kB a metre", "Of each tile of the default method, by the road it covers.",
                       {"kB a metre", "tiles"}, {{"tiles", "m7", data.tile_kb_per_m}})};
  Json parts = Json::array();
  for (const Figure& figure : figures) parts.push_back(json_of(figure));
  return {{"part", "group"},
          {"heading", "Distributions"},
          {"note", "The last bin of each holds all that is beyond it."},
          {"parts", parts}};
}

}  // namespace milepost
