// Routes to stored cells: those that intersect a box, or one.
#include "server/routes/answers.h"
#include "server/routes/lookup.h"
#include "server/routes/routes.h"

namespace milepost::server {
namespace {

constexpr const char* kForm = "write bbox=WEST,SOUTH,EAST,NORTH in degrees";

// The numbers of "1,2,3".
Result<std::vector<double>> numbers_of(std::string_view text, const std::string& where) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    const Result<double> number = parse_number(text.substr(0, comma), where);
    if (!number) return number.error();
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

Result<Bounds> box_of(const Query& query) {
  const Result<std::string> text = query.text("bbox");
  if (!text) return text.error();
  const Result<std::vector<double>> degrees = numbers_of(*text, "a side of bbox");
  if (!degrees) return degrees.error();
  if (degrees->size() != 4) {
    return Error{ErrorCode::invalid_input, "parameter bbox", "is not four numbers", kForm};
  }
  const Bounds box{(*degrees)[0], (*degrees)[1], (*degrees)[2], (*degrees)[3]};
  if (box.south_deg > box.north_deg) {
    return Error{ErrorCode::invalid_input, "parameter bbox", "south is greater than north", kForm};
  }
  if (!box.is_valid()) {
    return Error{ErrorCode::invalid_input, "parameter bbox", "is out of range",
                 "write longitudes in [-180, 180] and latitudes in [-90, 90]"};
  }
  return box;
}

}  // namespace

Result<Response> answer_cell_range(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<Bounds> box = box_of(call.query);
  if (!box) return box.error();
  const Result<const std::vector<CellEntry>*> index = find_cells(**map, call.path[2]);
  if (!index) return index.error();

  CellList list{*map, call.path[2], {}};
  for (const CellEntry& entry : **index) {
    if (GridCell::numbered(entry.cell).bounds().meets(*box)) list.cells.push_back(&entry);
  }
  const std::string digest = digest_of_all(list.cells);
  return immutable_cells(std::move(list), digest);
}

Result<Response> answer_cell(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const std::vector<CellEntry>*> index = find_cells(**map, call.path[2]);
  if (!index) return index.error();
  const Result<const CellEntry*> cell = find_cell(**index, call.path[3]);
  if (!cell) return cell.error();
  return divisible(immutable_cells({*map, call.path[2], {*cell}}, (*cell)->digest));
}

}  // namespace milepost::server
