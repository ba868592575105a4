/* Maps every world with a directional marker. far[v][i] is the other end of dart i of vertex v. */
#include <stdio.h>
#include <stdlib.h>
#define MOST 256 /* vertices, and darts of a vertex */

struct end { int v, i; } far[MOST][MOST], pose; /* v is -1 where the other end is not known */
int degree[MOST], vertices, doors, marker;      /* marker is -1 where there is none */

void receive(void) {
    char word[8];
    if (scanf(" {\"percept\":{\"degree\":%d,\"marker\":%7[^}]}}", &doors, word) != 2) exit(0);
    marker = word[0] == 'n' ? -1 : atoi(word);
}

void go(int door) {
    printf("{\"door\":%d}\n", door);
    fflush(stdout);
    receive();
}

void add_vertex(void) {
    if (vertices == MOST || doors > MOST) exit(1);
    for (int i = 0; i < doors; i++) far[vertices][i].v = -1;
    degree[vertices++] = doors;
}

/* Goes to the marker; or comes back, if the robot did not come in by dart at.i of vertex at.v. */
int home(struct end at) {
    int back[MOST], steps = 0;
    while (doors == degree[at.v] && marker == (at.v ? -1 : (doors - at.i) % doors)) {
        pose = at;
        if (at.v == 0) return 1;
        back[steps++] = at.i;
        go((doors - at.i) % doors);
        at = far[at.v][0];
    }
    if (steps == 0) return 0;
    go(0);
    while (steps > 0) go(back[--steps]);
    go(0);
    return 0;
}

/* Goes from the marker to a vertex, and leaves it by a dart. */
void follow(struct end end) {
    if (end.v) follow(far[end.v][0]);
    go((end.i - pose.i + degree[end.v]) % degree[end.v]);
    pose = far[end.v][end.i];
}

/* The end after this one in the map; v is -1 after the last. */
struct end next(struct end end) {
    if (++end.i == degree[end.v]) end.i = 0, end.v++;
    if (end.v == vertices) end.v = -1;
    return end;
}

void explore(void) {
    const struct end start = {0, 0};
    vertices = 0, pose = start;
    add_vertex();
    for (struct end edge = start; edge.v >= 0; edge = next(edge)) {
        if (far[edge.v][edge.i].v >= 0) continue;
        home(pose);
        follow(edge);
        struct end end = next(edge);
        while (end.v >= 0 && (far[end.v][end.i].v >= 0 || !home(end))) end = next(end);
        if (end.v < 0) {
            end.v = vertices, end.i = 0, pose = end;
            add_vertex();
        }
        far[edge.v][edge.i] = end, far[end.v][end.i] = edge;
    }
    printf("{\"map\":[");
    for (struct end at = start; at.v >= 0; at = next(at)) {
        struct end end = far[at.v][at.i];
        printf("%s[%d,%d]", at.i ? "," : at.v ? "],[" : "[", end.v, end.i);
    }
    printf("]],\"pose\":[%d,%d]}\n", pose.v, pose.i);
    fflush(stdout);
}

int main(void) {
    for (;;) {
        receive();
        explore();
    }
}
