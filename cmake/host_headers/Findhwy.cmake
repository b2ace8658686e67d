# Highway without run-time dispatch needs no library.
echinus_header_library(hwy::hwy)
set(hwy_FOUND TRUE)
