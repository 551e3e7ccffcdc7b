"""SCons script of the offline `native` platform: build one program with the host's gcc.

Not a module of the set-up, which copies it into the kit (offline_kit.py).
"""

from SCons.Script import AlwaysBuild, Default, DefaultEnvironment

env = DefaultEnvironment()

# Loading the compiler tools resets these flags, which PlatformIO has set by now.
c_flags, cxx_flags = env.get("CFLAGS", []), env.get("CXXFLAGS", [])
for name in ("CC", "CXX"):
    if name in env:
        del env[name]
env.Tool("gcc")
env.Tool("g++")
env.Append(CFLAGS=c_flags, CXXFLAGS=cxx_flags)

program = env.BuildProgram()
execute = env.VerboseAction("$SOURCE $PROGRAM_ARGS", "Executing $SOURCE")
AlwaysBuild(env.Alias("exec", program, execute))
Default([program])
