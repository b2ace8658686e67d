#pragma once

/// Keeps the calling thread, and threads that it starts from now on, on one core: the last of those that it
/// may use, which has the least to do for the system.
void pin_to_one_core();

/// Lets the calling thread run on every core again.
void unpin();
