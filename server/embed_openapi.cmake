# Writes a C++ source with the text of INPUT. cmake -D INPUT=... -D OUTPUT=... -P embed_openapi.cmake
file(READ "${INPUT}" text)
file(WRITE "${OUTPUT}" "#include \"server/routes/openapi.h\"

namespace milepost::server {

std::string_view openapi_yaml() {
  return R\"~yaml~(${text})~yaml~\";
}

}  // namespace milepost::server
")
