// Routes of the viewer: its page, its files, and what tiles hold as documents.
#include "server/viewer/viewer.h"

#include "schema/tile/layer_parameters.h"
#include "server/routes/answers.h"
#include "server/routes/lookup.h"
#include "server/routes/routes.h"
#include "server/viewer/places.h"

namespace milepost::server {
namespace {

const char* content_type_of(const std::string& file) {
  return file.ends_with(".css") ? "text/css; charset=utf-8" : "text/javascript; charset=utf-8";
}

Result<Response> document_or(const Result<std::string>& document) {
  if (!document) return document.error();
  return immutable_json(document_of(*document));
}

}  // namespace

Result<Response> answer_page(const Call& call) {
  Response response = current_text(call.viewer.page(), "text/html; charset=utf-8");
  response.headers.emplace_back("Content-Security-Policy", call.viewer.policy());
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  return response;
}

Result<Response> answer_viewer_file(const Call& call) {
  const std::string& name = call.path[1];
  const Document* file = call.path[0] == call.viewer.release() ? call.viewer.file(name) : nullptr;
  if (file == nullptr) {
    return Error{ErrorCode::not_found, "the viewer's file '" + name + "'", "does not exist",
                 "load / again"};
  }
  Response response = immutable_text(*file, content_type_of(name));
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  return response;
}

Result<Response> answer_viewer_landmarks(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const ServedSegment*> segment = find_segment(**map, call.path[2]);
  if (!segment) return segment.error();
  const Result<const std::vector<TileEntry>*> index = find_layer(**segment, layers::kLandmarks);
  if (!index) return index.error();
  const Result<const TileEntry*> tile = find_tile(**index, call.path[3]);
  if (!tile) return tile.error();
  const Result<Bytes> frame = (*map)->tile(call.path[2], layers::kLandmarks, **tile);
  if (!frame) return frame.error();
  return document_or(landmarks_document(*frame, (*segment)->line.line));
}

Result<Response> answer_viewer_walls(const Call& call) {
  const Result<std::shared_ptr<const ServedMap>> map =
      find_build(call.catalog, call.path[0], call.path[1]);
  if (!map) return map.error();
  const Result<const std::vector<CellEntry>*> index = find_cells(**map, layers::kWalls);
  if (!index) return index.error();
  const Result<const CellEntry*> cell = find_cell(**index, call.path[2]);
  if (!cell) return cell.error();
  const Result<Bytes> frame = (*map)->cell(layers::kWalls, **cell);
  if (!frame) return frame.error();
  return document_or(walls_document(*frame));
}

}  // namespace milepost::server
