# Writes a C++ source with the viewer's files. cmake -D FILES=A,B,... -D LEAFLET=FILE -D LICENCE=FILE -D OUTPUT=...
# -P embed_files.cmake. LEAFLET is embedded as leaflet.js, after its licence.
set(entries "")
string(REPLACE "," ";" files "${FILES}")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND entries "      {\"${name}\", R\"~file~(${text})~file~\"},\n")
endforeach()

file(READ "${LEAFLET}" leaflet)
string(FIND "${leaflet}" "export{" exports)
string(FIND "${leaflet}" ")~file~\"" end)
if(exports EQUAL -1 OR NOT end EQUAL -1)
  message(FATAL_ERROR "${LEAFLET}: is not Leaflet as a module; install libjs-leaflet (deploy/install-packages)")
endif()
string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" leaflet "${leaflet}")
file(READ "${LICENCE}" licence)
string(APPEND entries "      {\"leaflet.js\", R\"~file~(/*\n${licence}*/\n${leaflet})~file~\"},\n")

file(WRITE "${OUTPUT}" "#include \"server/viewer/viewer_files.h\"

namespace milepost::server {

const std::vector<ViewerFile>& viewer_files() {
  static const std::vector<ViewerFile> files = {
${entries}  };
  return files;
}

}  // namespace milepost::server
")
