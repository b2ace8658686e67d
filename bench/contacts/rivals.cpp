#include "contacts/system.hpp"

void list_contacts_rivals(ContactsList& list) {
#ifdef ECHINUS_BENCH_CLASSIFIED_GRID
    list_classified_grid(list);
#endif
    list_dense_grid(list);
#ifdef ECHINUS_BENCH_VDB
    list_nanovdb(list);
    list_openvdb(list);
#endif
    list_embree(list);
    list_cgal(list);
#ifdef ECHINUS_BENCH_FCL
    list_fcl(list);
#endif
}

void list_sizes_of_contacts_rivals(ContactsList& list) {
    list_sizes_of_dense_grid(list);
#ifdef ECHINUS_BENCH_CLASSIFIED_GRID
    list_sizes_of_classified_grid(list);
#endif
}
