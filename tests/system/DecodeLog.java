// What lcm-spy does with a message, without its window: finds the class by the message's fingerprint
// in the jars on the class path, decodes, and counts by channel.
//   java -cp lcm.jar:digsight_types.jar DecodeLog.java LOG

import java.util.TreeMap;

public class DecodeLog {
    public static void main(String[] args) throws Exception {
        lcm.spy.LCMTypeDatabase types = new lcm.spy.LCMTypeDatabase();
        TreeMap<String, Integer> counts = new TreeMap<>();
        lcm.logging.Log log = new lcm.logging.Log(args[0], "r");
        try {
            while (true) {
                lcm.logging.Log.Event event = log.readNext();
                long fingerprint = java.nio.ByteBuffer.wrap(event.data).getLong();
                Class<?> type = types.getClassByFingerprint(fingerprint);
                if (type == null) {
                    System.out.println(event.channel + " unknown");
                    System.exit(1);
                }
                type.getConstructor(java.io.DataInput.class)
                    .newInstance(new lcm.lcm.LCMDataInputStream(event.data));
                counts.merge(event.channel + " " + type.getName(), 1, Integer::sum);
            }
        } catch (java.io.EOFException end) {
            counts.forEach((name, count) -> System.out.println(name + " " + count));
        }
    }
}
