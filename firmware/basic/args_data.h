// BASIC_ARG_DATA and BASIC_ARG_STORE at run time; see also basic_data_number(). Context: main loop.
#ifndef BASIC_ARGS_DATA_H
#define BASIC_ARGS_DATA_H

#include "basic/basic.h"
#include "value.h"

// `count` values, at least 1. Errors: they are not numbers, one string or one array of numbers.
void args_data_deliver(const basic_arg_spec_t *spec, const value_t *values, unsigned count,
                       basic_arg_t *arg);

// Errors: a constant, an array of strings.
void args_data_deliver_store(const basic_arg_spec_t *spec, const value_t *value, basic_arg_t *arg);

#endif
