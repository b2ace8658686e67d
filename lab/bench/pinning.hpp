#pragma once

/// Keeps the calling thread, and threads that it starts from now on, on one core: the last of those it may
/// use, which the system uses least.
void pin_to_one_core();

/// Lets the calling thread run on every core again.
void unpin();
