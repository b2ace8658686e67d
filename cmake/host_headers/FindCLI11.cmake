echinus_header_library(CLI11::CLI11)
set(CLI11_FOUND TRUE)
