#pragma once

/// Everything that the shared libraries export stands in a namespace with this mark: the public headers, and
/// the few internal ones that one of the libraries takes from another. All else is hidden.
#if defined(__GNUC__)
#define ECHINUS_EXPORT [[gnu::visibility("default")]]
#else
#define ECHINUS_EXPORT
#endif
