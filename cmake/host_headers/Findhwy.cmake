# Highway without run-time choice of the instruction set needs nothing of its library.
echinus_header_library(hwy::hwy)
set(hwy_FOUND TRUE)
