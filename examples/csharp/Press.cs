// Presses a sphere into the organ of the examples, as tests/c/press.c does, and prints the same lines. Then it ticks and
// reads the surface 200 000 times, and fails when the garbage collector ran.
//
//   mcs -out:press.exe Palpate.cs Organ.cs Press.cs
//   LD_LIBRARY_PATH=<folder of libpalpate_c.so> mono press.exe organ.msh
using System;
using System.Diagnostics;
using Palpate;

static class Press
{
    const int Ticks = 1024, Timed = 100000;

    static void Place(ref ToolState state, int i, double time)
    {
        state.Position.X = -127.0 / 4096;
        state.Position.Y = (-147.0 * 1024 + 16.0 * i) / (4096.0 * 1024);
        state.Position.Z = (246.0 * 1024 - 90.0 * i) / (4096.0 * 1024);
        state.Time = state.Now = time;
        state.Given = ToolState.HasNow;
    }

    static ulong AddToHash(ulong hash, double value)
    {
        ulong bits = (ulong)BitConverter.DoubleToInt64Bits(value);
        for (int k = 0; k < 8; ++k, bits >>= 8) hash = unchecked((hash ^ (bits & 255)) * 1099511628211UL);
        return hash;
    }
    static ulong AddToHash(ulong hash, Vector v) { return AddToHash(AddToHash(AddToHash(hash, v.X), v.Y), v.Z); }

    static string Hex(double value) { return BitConverter.DoubleToInt64Bits(value).ToString("x16"); }

    static double TimeTicks(Organ organ, int i, ref int tick)
    {
        var state = ToolState.Create();
        var force = ToolForce.Create();
        TimeSpan start = Process.GetCurrentProcess().TotalProcessorTime;
        for (int k = 0; k < Timed; ++k)
        {
            Place(ref state, i, 1e-3 * tick++);
            organ.Tick(ref state, ref force);
        }
        return 1e3 * (Process.GetCurrentProcess().TotalProcessorTime - start).TotalMilliseconds / Timed;
    }

    static int Main(string[] arguments)
    {
        if (arguments.Length < 1) return 2;
        int stages = 0;
        var material = new Material { YoungsModulus = 5e3, PoissonRatio = 0.45, Density = 1060.0 };
        using (var organ = new Organ(arguments[0], "smoothed_tet4/linear/condensed", "ligament", "front", material,
                                     Tool.Sphere(4e-3), (stage, fraction) => { ++stages; return true; }))
        {
            var state = ToolState.Create();
            var force = ToolForce.Create();
            ulong hash = 14695981039346656037UL;
            int tick = 0;
            for (; tick < Ticks; ++tick)
            {
                Place(ref state, tick, 1e-3 * tick);
                organ.Tick(ref state, ref force);
                hash = AddToHash(AddToHash(hash, force.Force), force.ContactForce);
            }
            double pressed = TimeTicks(organ, 1024, ref tick), free = TimeTicks(organ, 0, ref tick);
            Vector f = force.ContactForce;
            Console.WriteLine("hash {0:x16}\nforce {1} {2} {3}", hash, Hex(f.X), Hex(f.Y), Hex(f.Z));
            Console.WriteLine(FormattableString.Invariant($"free_us {free:F3}\npressed_us {pressed:F3}"));
            return Collections(organ, tick) == 0 && stages > 0 && Refuses() ? 0 : 1;
        }
    }

    // Collections during 200 000 ticks, with the surface read in every 33rd.
    static int Collections(Organ organ, int tick)
    {
        var state = ToolState.Create();
        var force = ToolForce.Create();
        organ.ReadSurface();
        int before = Count();
        for (int k = 0; k < 200000; ++k)
        {
            Place(ref state, 512 + k % 512, 1e-3 * tick++);
            organ.Tick(ref state, ref force);
            if (k % 33 == 0 && k < 20000) organ.ReadSurface();
        }
        int collections = Count() - before;
        Console.WriteLine("collections {0}", collections);
        return collections;
    }
    static int Count()
    {
        int count = 0;
        for (int generation = 0; generation <= GC.MaxGeneration; ++generation) count += GC.CollectionCount(generation);
        return count;
    }

    // A refusal is an exception with the text of the library.
    static bool Refuses()
    {
        var material = new Material { YoungsModulus = 5e3, PoissonRatio = 0.5 };
        try { new Organ("no such file.msh", "smoothed_tet4/linear/condensed", "", "", material, Tool.Sphere(4e-3), null); }
        catch (PalpateException e) { return e.Message.Contains("no such file.msh"); }
        return false;
    }
}
