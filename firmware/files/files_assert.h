// Taken in by littlefs itself (cmake/littlefs.cmake): what becomes of its assertions. Only a
// damaged image can break one. Context: main loop.
#ifndef FILES_ASSERT_H
#define FILES_ASSERT_H

// Leaves the call of littlefs that is under way (files_volume.c).
void files_give_up(void) __attribute__((noreturn));

#define LFS_ASSERT(test) ((test) ? (void)0 : files_give_up())

#endif
