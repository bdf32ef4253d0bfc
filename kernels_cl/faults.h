// Faults to plant in this dialect, so that tests can see the comparison of backends name the stage
// that differs. The build option FAULT picks one; FAULT_none, the rule, none.
#pragma once

// X(name): what BackendOptions::plant_fault may say.
#define FAULTS(X) \
    X(sqrt)       \
    X(floor)

#define FAULT_NUMBER(name) FAULT_##name,
enum { FAULT_none, FAULTS(FAULT_NUMBER) FAULT_COUNT };

SHARED float faulty_sqrt(float x) { return FAULT == FAULT_sqrt ? sqrt(x) * 1.001f : sqrt(x); }
SHARED float faulty_floor(float x) { return FAULT == FAULT_floor ? floor(x) + 1.0f : floor(x); }

// What comes after this header calls the faulty ones.
#define math_sqrt(x) faulty_sqrt(x)
#define math_floor(x) faulty_floor(x)
