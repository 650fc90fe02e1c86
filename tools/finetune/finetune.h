// The commands of synpo-finetune.
#pragma once
int adapt(int argc, char** argv);
int ppo(int argc, char** argv);
int strip(int argc, char** argv);
