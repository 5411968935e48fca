#include <ppscat/ppscat.h>
#include <stdio.h>

int main(void) {
    pps_slab slab = {.albedo = 0.95, .g = 0.5, .thickness = 10};
    double mu0 = 0.5, top = 0;
    pps_model *model;
    pps_flux flux;
    pps_status status = pps_model_create(pps_method_find("exact"), &slab, NULL, &model);
    if (!status)
        status = pps_model_solve(model, slab.thickness, mu0);
    if (!status)
        status = pps_model_flux(model, 1, &top, &flux);
    if (!status)
        printf("reflectance %.6f\n", flux.up / mu0);
    pps_model_free(model);
    return status;
}
