// Built for a Pectora that never was.
extern "C" __attribute__((visibility("default"))) const char* pectora_build_stamp() { return "interface 0; long ago"; }
extern "C" __attribute__((visibility("default"))) const void* pectora_plugin() { __builtin_trap(); }
