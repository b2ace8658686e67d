echinus_header_library(nlohmann_json::nlohmann_json)
set(nlohmann_json_FOUND TRUE)
