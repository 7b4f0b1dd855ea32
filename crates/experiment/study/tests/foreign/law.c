/* A small controller with Bladed's interface, for tests: torque k w^2 below rated speed, the torque of rated
 * speed above, pitch by a PI law on speed. Its input file holds, in this order: k (N m s^2), rated speed
 * (rad/s), proportional (s) and integral (-) gain, greatest pitch (rad), what it does beside that, and when
 * (s). Speeds and torques are those of the high-speed shaft. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double k, rated, proportional, integral_gain, greatest, integral, when;
static char trick[32];
static int is_begun = 0;

static void say(char *message, int *fail, int flag, const char *text) {
    strcpy(message, text);
    *fail = flag;
}

void DISCON(float *swap, int *fail, char *input, char *output, char *message) {
    int status = (int)swap[0];
    double time = swap[1], step = swap[2], speed = swap[19];
    *fail = 0;
    if (status == 0) {
        FILE *file;
        /* As ROSCO does: an instance belongs to one turbine. */
        if (is_begun) { say(message, fail, -1, "this library has already been loaded"); return; }
        is_begun = 1;
        file = fopen(input, "r");
        if (file == NULL) { say(message, fail, -1, "cannot open the input file"); return; }
        if (fscanf(file, "%lf %lf %lf %lf %lf %31s %lf", &k, &rated, &proportional, &integral_gain, &greatest,
                   trick, &when) != 7) {
            fclose(file);
            say(message, fail, -1, "the input file holds too little");
            return;
        }
        fclose(file);
        integral = swap[3];
    }
    if (status == -1) {
        char name[4200];
        FILE *file;
        snprintf(name, sizeof name, "%s.log", output);
        file = fopen(name, "w");
        if (file != NULL) { fprintf(file, "ended at %.1f s\n", time); fclose(file); }
        return;
    }
    if (!strcmp(trick, "fail") && time > when) { say(message, fail, -1, "the gearbox\n is too hot"); return; }
    if (!strcmp(trick, "warn") && time > when) say(message, fail, 1, "the gearbox is warm");
    if (!strcmp(trick, "crash") && time > when) *(volatile int *)8 = 1;
    if (!strcmp(trick, "exit") && time > when) exit(0);
    {
        double error = speed - rated, pitch, torque;
        integral += integral_gain * error * step;
        if (integral < 0.0) integral = 0.0;
        if (integral > greatest) integral = greatest;
        pitch = integral + proportional * error;
        if (pitch < 0.0) pitch = 0.0;
        if (pitch > greatest) pitch = greatest;
        torque = speed < rated ? k * speed * speed : k * rated * rated;
        if (!strcmp(trick, "clock")) {
            struct timespec now;
            clock_gettime(CLOCK_REALTIME, &now);
            torque *= 1.0 - 1e-3 * (double)now.tv_nsec / 1e9;
        }
        if (!strcmp(trick, "number")) pitch = 0.0 / 0.0;
        if (!strcmp(trick, "yaw")) swap[47] = 0.01f;
        swap[41] = swap[42] = swap[43] = swap[44] = (float)pitch;
        swap[46] = (float)torque;
    }
}
