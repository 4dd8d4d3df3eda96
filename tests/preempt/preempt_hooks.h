// The names by which gcc's -fsanitize=thread calls its runtime, here ours (preempt.c).
#ifndef PREEMPT_HOOKS_H
#define PREEMPT_HOOKS_H

void __tsan_init(void);
void __tsan_read1(void *address);
void __tsan_read2(void *address);
void __tsan_read4(void *address);
void __tsan_read8(void *address);
void __tsan_read16(void *address);
void __tsan_write1(void *address);
void __tsan_write2(void *address);
void __tsan_write4(void *address);
void __tsan_write8(void *address);
void __tsan_write16(void *address);
void __tsan_unaligned_read2(void *address);
void __tsan_unaligned_read4(void *address);
void __tsan_unaligned_read8(void *address);
void __tsan_unaligned_read16(void *address);
void __tsan_unaligned_write2(void *address);
void __tsan_unaligned_write4(void *address);
void __tsan_unaligned_write8(void *address);
void __tsan_unaligned_write16(void *address);
void __tsan_read_range(void *address, unsigned long size);
void __tsan_write_range(void *address, unsigned long size);

#endif
